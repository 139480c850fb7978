#include "sim/files/usda_io.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <limits>
#include <set>

#include "kernels/index.h"
#include "sim/files/cache_frames.h"
#include "sim/files/file_io.h"

namespace icloth {
namespace {

/// Text that goes to the file in pieces.
class Writer {
 public:
  explicit Writer(const std::string& path) : file_(path) {}

  Writer& operator<<(std::string_view text) {
    text_ += text;
    if (text_.size() > kPiece) flush();
    return *this;
  }
  /// As few digits as give the number back.
  template <class Number>
  Writer& number(Number value) {
    char digits[40];
    const auto end = std::to_chars(std::begin(digits), std::end(digits), value).ptr;
    return *this << std::string_view(digits, static_cast<std::size_t>(end - digits));
  }
  Writer& vector(Vec3f v) {
    *this << "(";
    number(v.x) << ", ";
    number(v.y) << ", ";
    return number(v.z) << ")";
  }

  void commit() {
    flush();
    file_.commit();
  }

 private:
  static constexpr std::size_t kPiece = 1 << 20;

  void flush() {
    file_.write(text_);
    text_.clear();
  }

  OutputFile file_;
  std::string text_;
};

/// A list in brackets, `write(i)` for each of so many entries.
template <class Write>
void write_list(Writer& out, std::size_t count, const Write& write) {
  out << "[";
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) out << ", ";
    write(i);
  }
  out << "]";
}

/// `what` of all frames as time samples; `write(frame)` writes the value of one.
template <class Write>
void write_samples(Writer& out, const std::string& what, const CachedMesh& mesh, std::size_t frames,
                   const Write& write) {
  CacheFrames cache(mesh.cache);
  std::vector<Vec3f> frame(mesh.vertices);
  out << "        " << what << ".timeSamples = {\n";
  for (std::size_t f = 0; f < frames; ++f) {
    cache.next(frame);
    out << "            ";
    out.number(f) << ": ";
    write(frame);
    out << ",\n";
  }
  out << "        }\n";
}

/// Normals of the vertices, faces weighted with their areas; y up where there is no face.
std::vector<Vec3f> vertex_normals(const CachedMesh& mesh, const std::vector<Vec3f>& x) {
  std::vector<Vec3f> normals(x.size());
  for (const Triangle& t : mesh.faces) {
    const Vec3f n = cross(x[at(t[1])] - x[at(t[0])], x[at(t[2])] - x[at(t[0])]);
    for (const Index v : t) normals[at(v)] += n;
  }
  for (Vec3f& n : normals) n = norm(n) > 0 ? normalized(n) : Vec3f{0, 1, 0};
  return normals;
}

/// A name that the format takes for a prim, unlike those before.
std::string prim_name(const std::string& name, std::set<std::string>& taken) {
  std::string prim;
  for (const char c : name) prim += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  if (prim.empty() || std::isdigit(static_cast<unsigned char>(prim[0]))) prim.insert(0, 1, '_');
  std::string unique = prim;
  for (int number = 2; !taken.insert(unique).second; ++number)
    unique = std::string(prim).append("_").append(std::to_string(number));
  return unique;
}

void write_mesh(Writer& out, const CachedMesh& mesh, const std::string& name, std::size_t frames) {
  out << "    def Mesh \"" << name << "\"\n    {\n";

  // The faces stay the same for all frames.
  out << "        int[] faceVertexCounts = ";
  write_list(out, mesh.faces.size(), [&](std::size_t) { out << "3"; });
  out << "\n        int[] faceVertexIndices = ";
  write_list(out, 3 * mesh.faces.size(),
             [&](std::size_t i) { out.number(mesh.faces[i / 3][i % 3]); });
  out << "\n        uniform token subdivisionScheme = \"none\"\n";
  out << "        uniform bool doubleSided = true\n";
  if (!mesh.uv.empty()) {
    out << "        texCoord2f[] primvars:st = ";
    write_list(out, 3 * mesh.uv.size(), [&](std::size_t i) {
      const Vec2d uv = mesh.uv[i / 3][i % 3];
      out << "(";
      out.number(static_cast<float>(uv.x)) << ", ";
      out.number(static_cast<float>(uv.y)) << ")";
    });
    out << " (\n            interpolation = \"faceVarying\"\n        )\n";
  }

  // Each kind of sample goes over the cache once more.
  write_samples(out, "point3f[] points", mesh, frames, [&](const std::vector<Vec3f>& x) {
    write_list(out, x.size(), [&](std::size_t v) { out.vector(x[v]); });
  });
  write_samples(out, "normal3f[] normals", mesh, frames, [&](const std::vector<Vec3f>& x) {
    const std::vector<Vec3f> normals = vertex_normals(mesh, x);
    write_list(out, normals.size(), [&](std::size_t v) { out.vector(normals[v]); });
  });
  write_samples(out, "float3[] extent", mesh, frames, [&](const std::vector<Vec3f>& x) {
    constexpr float kFar = std::numeric_limits<float>::max();
    Vec3f low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};
    for (const Vec3f p : x) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    write_list(out, 2, [&](std::size_t i) { out.vector(i == 0 ? low : high); });
  });
  out << "    }\n";
}

}  // namespace

void write_usda(const std::string& path, std::span<const CachedMesh> meshes,
                std::span<const double> times) {
  constexpr double kUsualRate = 24;  // of a single frame, which needs none
  const double interval = times.size() > 1 ? times[1] - times[0] : 0;

  // The stage says how its numbers are meant.
  Writer out(path);
  out << "#usda 1.0\n(\n    defaultPrim = \"icloth\"\n    endTimeCode = ";
  out.number(times.empty() ? 0 : times.size() - 1) << "\n    metersPerUnit = 1\n";
  out << "    startTimeCode = 0\n    timeCodesPerSecond = ";
  out.number(interval > 0 ? 1 / interval : kUsualRate) << "\n    upAxis = \"Y\"\n)\n\n";

  out << "def Xform \"icloth\"\n{\n";
  std::set<std::string> taken;
  for (const CachedMesh& mesh : meshes)
    write_mesh(out, mesh, prim_name(mesh.name, taken), times.size());
  out << "}\n";
  out.commit();
}

}  // namespace icloth
