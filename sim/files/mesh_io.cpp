#include "sim/files/mesh_io.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdio>
#include <initializer_list>
#include <map>

#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/mesh_formats.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

/// 9 significant digits bring every float back; no locale is involved.
void append_number(std::string& text, float value) {
  char digits[32];
  const auto end =
      std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 9).ptr;
  text.append(digits, end);
}

void append_index(std::string& text, std::size_t value) {
  char digits[24];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

/// A statement of so many numbers.
void append_row(std::string& text, const char* key, std::initializer_list<float> numbers) {
  text += key;
  for (const float number : numbers) {
    text += ' ';
    append_number(text, number);
  }
  text += '\n';
}

/// The numbers of texture coordinates in a file, counted from 1.
class UvNumbers {
 public:
  /// Writes those that the file does not have yet.
  void append_new(std::string& text, std::span<const std::array<Vec2d, 3>> uv) {
    for (const std::array<Vec2d, 3>& face : uv)
      for (const Vec2d corner : face)
        if (numbers_.try_emplace(key(corner), numbers_.size() + 1).second)
          append_row(text, "vt", {static_cast<float>(corner.x), static_cast<float>(corner.y)});
  }
  std::size_t of(Vec2d uv) const { return numbers_.at(key(uv)); }

 private:
  using Bits = std::array<std::uint32_t, 2>;

  static Bits key(Vec2d uv) {
    return {std::bit_cast<std::uint32_t>(static_cast<float>(uv.x)),
            std::bit_cast<std::uint32_t>(static_cast<float>(uv.y))};
  }
  std::map<Bits, std::size_t> numbers_;
};

std::string describe(const Triangle& face) {
  return "vertices " + std::to_string(face[0]) + " " + std::to_string(face[1]) + " " +
         std::to_string(face[2]);
}

/// Twice the area against the square of the longest edge; 0 for a point.
double flatness(const TriangleMesh& mesh, const Triangle& face) {
  const auto at = [&](std::size_t c) { return mesh.positions[static_cast<std::size_t>(face[c])]; };
  const Vec3d a = at(1) - at(0), b = at(2) - at(0), c = at(2) - at(1);
  const double longest = std::max({norm2(a), norm2(b), norm2(c)});
  return longest > 0 ? norm(cross(a, b)) / longest : 0;
}

}  // namespace

MeshFile read_mesh(const std::string& path) {
  const std::string name = shown_path(path);
  const std::string extension = lower_extension(path);
  if (extension != ".obj" && extension != ".ply")
    throw InputError(name + ": value " + in_quotes(extension) +
                     ", expected the extension .obj or .ply");
  const std::string text = read_file(path);
  MeshFile file = extension == ".obj" ? parse_obj(text, name) : parse_ply(text, name);
  if (file.mesh.faces.empty()) throw InputError(name + ": 0 triangles, expected at least one");
  return file;
}

void check_cloth_mesh(const TriangleMesh& mesh, const std::string& name) {
  constexpr double kFlat = 1e-9;
  if (mesh.faces.empty()) throw InputError(name + ": 0 triangles, expected at least one");

  // The strain of a face without area cannot be measured.
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Triangle& face = mesh.faces[f];
    const std::string element = name + ": triangle " + std::to_string(f) + ": ";
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0])
      throw InputError(element + describe(face) + ", expected three different vertices");
    if (flatness(mesh, face) < kFlat)
      throw InputError(element + describe(face) + " span no area, expected an area above 0");
  }
}

void check_edges(const TriangleMesh& mesh, const std::string& name,
                 std::span<const Index> numbers) {
  const auto number = [&](Index v) {
    return std::to_string(numbers.empty() ? v : numbers[static_cast<std::size_t>(v)]);
  };

  // After sorting by vertices, all sides of one edge stand together.
  std::vector<std::array<Index, 2>> edges;
  edges.reserve(3 * mesh.faces.size());
  for (const Triangle& t : mesh.faces)
    for (std::size_t c = 0; c < 3; ++c)
      edges.push_back({std::min(t[c], t[(c + 1) % 3]), std::max(t[c], t[(c + 1) % 3])});
  std::ranges::sort(edges);

  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end] == edges[begin]) ++end;
    if (end - begin <= kMostFacesOnEdge) continue;
    throw InputError(name + ": edge between vertices " + number(edges[begin][0]) + " and " +
                     number(edges[begin][1]) + ": " + std::to_string(end - begin) +
                     " faces, expected at most " + std::to_string(kMostFacesOnEdge));
  }

  // The faces of every vertex are counted.
  std::vector<std::size_t> count(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.faces)
    for (const Index v : t) ++count[static_cast<std::size_t>(v)];
  const auto most = std::ranges::max_element(count);
  if (most != count.end() && *most > kMostFacesAtVertex)
    throw InputError(name + ": vertex " + number(static_cast<Index>(most - count.begin())) + ": " +
                     std::to_string(*most) + " faces, expected at most " +
                     std::to_string(kMostFacesAtVertex));
}

void write_obj(const std::string& path, std::span<const NamedMesh> objects,
               const std::string& comment, ObjUv uv) {
  std::string text = comment.empty() ? "" : "# " + comment + "\n";
  std::size_t first = 1;
  UvNumbers numbers;
  for (const NamedMesh& object : objects) {
    text += "g " + file_line(object.name) + "\n";
    for (const Vec3f p : object.positions) append_row(text, "v", {p.x, p.y, p.z});

    // Corners with the same texture coordinates share one entry of the file.
    const bool with_uv = uv == ObjUv::written && !object.uv.empty();
    if (with_uv) numbers.append_new(text, object.uv);
    for (std::size_t f = 0; f < object.faces.size(); ++f) {
      text += 'f';
      for (std::size_t c = 0; c < 3; ++c) {
        text += ' ';
        append_index(text, first + static_cast<std::size_t>(object.faces[f][c]));
        if (!with_uv) continue;
        text += '/';
        append_index(text, numbers.of(object.uv[f][c]));
      }
      text += '\n';
    }
    first += object.positions.size();
  }
  write_file(path, text);
}

void write_cloth_obj(const std::string& path, const TriangleMesh& mesh,
                     std::span<const Index> piece, std::span<const std::string> names,
                     const std::string& comment) {
  std::string text = "# " + comment + "\n";
  char line[120];
  for (Vec3d p : mesh.positions) {
    std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", p.x, p.y, p.z);
    text += line;
  }

  // A place of the pattern that several corners have is written once.
  std::map<std::array<double, 2>, std::size_t> number;
  const auto number_of = [&](Vec2d uv) {
    const auto [entry, is_new] = number.try_emplace({uv.x, uv.y}, number.size() + 1);
    if (is_new) {
      std::snprintf(line, sizeof line, "vt %.12g %.12g\n", uv.x, uv.y);
      text += line;
    }
    return entry->second;
  };

  std::string faces;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (f == 0 || piece[f] != piece[f - 1])
      faces += "g " + names[static_cast<std::size_t>(piece[f])] + "\n";
    faces += 'f';
    for (std::size_t c = 0; c < 3; ++c) {
      faces += ' ';
      append_index(faces, static_cast<std::size_t>(mesh.faces[f][c]) + 1);
      faces += '/';
      append_index(faces, number_of(mesh.uv[f][c]));
    }
    faces += '\n';
  }
  write_file(path, text + faces);
}

}  // namespace icloth
