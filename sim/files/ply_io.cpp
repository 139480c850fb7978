// PLY: ascii and binary of either byte order. Positions and faces are read, all else is skipped.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <sstream>

#include "sim/files/error.h"
#include "sim/files/file_io.h"
#include "sim/files/mesh_formats.h"
#include "sim/files/polygon.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

static_assert(std::endian::native == std::endian::little, "big endian files alone are turned");

enum class Scalar { i8, u8, i16, u16, i32, u32, f32, f64 };

struct ScalarName {
  std::string_view name;
  Scalar type;
  std::size_t bytes;
};
constexpr ScalarName kScalars[] = {
    {"char", Scalar::i8, 1},    {"uchar", Scalar::u8, 1},   {"short", Scalar::i16, 2},
    {"ushort", Scalar::u16, 2}, {"int", Scalar::i32, 4},    {"uint", Scalar::u32, 4},
    {"float", Scalar::f32, 4},  {"double", Scalar::f64, 8}, {"int8", Scalar::i8, 1},
    {"uint8", Scalar::u8, 1},   {"int16", Scalar::i16, 2},  {"uint16", Scalar::u16, 2},
    {"int32", Scalar::i32, 4},  {"uint32", Scalar::u32, 4}, {"float32", Scalar::f32, 4},
    {"float64", Scalar::f64, 8}};

struct Property {
  std::string name;
  ScalarName type{};
  bool list = false;
  ScalarName count{};  ///< of a list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;

  /// Least bytes an item takes, for the check of the announced count against the file.
  std::size_t least_bytes(bool ascii) const {
    std::size_t bytes = 0;
    for (const Property& p : properties)
      bytes += ascii ? 2 : (p.list ? p.count.bytes : p.type.bytes);
    return std::max<std::size_t>(bytes, 1);
  }
};

enum class Format { ascii, little_endian, big_endian };

template <class T>
double load(const char* bytes, Format format) {
  char ordered[sizeof(T)];
  std::copy_n(bytes, sizeof ordered, ordered);
  if (format == Format::big_endian) std::reverse(ordered, ordered + sizeof ordered);
  T value;
  std::memcpy(&value, ordered, sizeof value);
  return static_cast<double>(value);
}

class PlyParser {
 public:
  PlyParser(std::string_view bytes, const std::string& path) : rest_(bytes), path_(path) {}

  MeshFile parse() {
    parse_header();
    for (const Element& element : elements_) check_count(element);
    for (const Element& element : elements_) parse_element(element);
    cut_faces();
    const auto count = static_cast<Index>(file_.mesh.faces.size());
    file_.groups.push_back({std::filesystem::path(path_).stem().string(), 0, count});
    return std::move(file_);
  }

 private:
  [[noreturn]] void refuse(const std::string& element, std::string_view value,
                           const std::string& expected) const {
    throw InputError(path_ + ": " + element + ": value " + in_quotes(value) + ", expected " +
                     expected);
  }

  std::string_view header_line() {
    const std::size_t end = rest_.find('\n');
    if (end == std::string_view::npos) refuse("header", "(end of file)", "end_header");
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return line;
  }

  void parse_header() {
    if (Words(header_line()).next() != "ply") refuse("header", "", "the first line 'ply'");
    for (;;) {
      Words words(header_line());
      const std::string_view key = words.next();
      if (key == "end_header") break;

      // Lines with other keywords, such as comments, are passed over.
      if (key == "format") parse_format(words.next());
      if (key == "element") add_element(words);
      if (key == "property") add_property(words);
    }
    if (!has_format_) refuse("header", "", "a line 'format'");
  }

  void parse_format(std::string_view format) {
    if (format == "ascii") {
      format_ = Format::ascii;
    } else if (format == "binary_little_endian") {
      format_ = Format::little_endian;
    } else if (format == "binary_big_endian") {
      format_ = Format::big_endian;
    } else {
      refuse("format", format, "ascii, binary_little_endian or binary_big_endian");
    }
    has_format_ = true;
  }

  void add_element(Words& words) {
    Element element;
    element.name = words.next();
    const std::string_view count = words.next();
    const auto [end, error] =
        std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (error != std::errc{} || end != count.data() + count.size() || element.count > kLargestCount)
      refuse("element " + excerpt(element.name), count, "a count from 0 to 536870911");
    elements_.push_back(element);
  }

  ScalarName scalar(std::string_view name) const {
    for (const ScalarName& s : kScalars)
      if (s.name == name) return s;
    refuse("property", name, "a scalar type such as float or int");
  }

  void add_property(Words& words) {
    if (elements_.empty()) refuse("property", "", "an element before it");
    Property property;
    std::string_view word = words.next();
    if (word == "list") {
      property.list = true;
      property.count = scalar(words.next());
      word = words.next();
    }
    property.type = scalar(word);
    property.name = words.next();
    elements_.back().properties.push_back(property);
  }

  void check_count(const Element& element) const {
    if (element.count > rest_.size() / element.least_bytes(format_ == Format::ascii))
      refuse("element " + excerpt(element.name), std::to_string(element.count),
             "no more than fit into the " + std::to_string(rest_.size()) +
                 " bytes that follow the header");
  }

  double next_number(const ScalarName& type, const std::string& where) {
    if (format_ == Format::ascii) return next_ascii(where);

    // Binary numbers come in the byte order that the header gives.
    if (rest_.size() < type.bytes) refuse(where, "(end of file)", "more data");
    const char* bytes = rest_.data();
    rest_.remove_prefix(type.bytes);

    switch (type.type) {
      case Scalar::i8:
        return load<std::int8_t>(bytes, format_);
      case Scalar::u8:
        return load<std::uint8_t>(bytes, format_);
      case Scalar::i16:
        return load<std::int16_t>(bytes, format_);
      case Scalar::u16:
        return load<std::uint16_t>(bytes, format_);
      case Scalar::i32:
        return load<std::int32_t>(bytes, format_);
      case Scalar::u32:
        return load<std::uint32_t>(bytes, format_);
      case Scalar::f32:
        return load<float>(bytes, format_);
      case Scalar::f64:
        break;
    }
    return load<double>(bytes, format_);
  }

  double next_ascii(const std::string& where) {
    const std::size_t begin = rest_.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos) refuse(where, "(end of file)", "more data");
    const std::size_t end = std::min(rest_.find_first_of(" \t\r\n", begin), rest_.size());
    const std::string_view word = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    double value = 0;
    const auto [last, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || last != word.data() + word.size()) refuse(where, word, "a number");
    return value;
  }

  std::size_t list_length(const Property& property, const std::string& where) {
    const double count = next_number(property.count, where);
    // Every entry takes a byte at least, so a list is never longer than the rest of the file.
    if (!(count >= 0) || count != std::floor(count) || count > static_cast<double>(rest_.size()))
      refuse(where, number_text(count), "a list length within the file");
    return static_cast<std::size_t>(count);
  }

  void parse_element(const Element& element) {
    const std::string name = excerpt(element.name);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const std::string where = name + " " + std::to_string(i);
      if (element.name == "vertex") {
        parse_vertex(element, where);
      } else {
        parse_item(element, where);
      }
    }
  }

  void parse_vertex(const Element& element, const std::string& where) {
    std::array<double, 3> p;
    p.fill(std::numeric_limits<double>::quiet_NaN());

    // Files may hold properties besides the coordinates and have them in any order.
    for (const Property& property : element.properties) {
      const std::size_t count = property.list ? list_length(property, where) : 1;
      for (std::size_t k = 0; k < count; ++k) {
        const double value = next_number(property.type, where);
        const std::size_t axis = std::string_view("xyz").find(property.name);
        if (property.name.size() == 1 && axis < 3) p[axis] = value;
      }
    }

    // A coordinate that the file lacks is still not a number here, and is refused as well.
    for (double x : p)
      if (!(std::abs(x) <= kLargestCoordinate))
        refuse(where, number_text(x), "three finite coordinates");
    file_.mesh.positions.push_back({p[0], p[1], p[2]});
  }

  void parse_item(const Element& element, const std::string& where) {
    for (const Property& property : element.properties) {
      if (!property.list) {
        next_number(property.type, where);
        continue;
      }

      // Lists other than the corners of faces are read and forgotten.
      const bool is_face = element.name == "face" &&
                           (property.name == "vertex_indices" || property.name == "vertex_index");
      const std::size_t count = list_length(property, where);
      if (is_face && count < 3) refuse(where, std::to_string(count) + " corners", "at least three");
      parse_corners(property, count, is_face, where);
    }
  }

  void parse_corners(const Property& property, std::size_t count, bool is_face,
                     const std::string& where) {
    for (std::size_t k = 0; k < count; ++k) {
      const double value = next_number(property.type, where);
      if (!is_face) continue;
      if (!(value >= 0 && value < std::numeric_limits<Index>::max()) || value != std::floor(value))
        refuse(where, std::to_string(value), "the number of a vertex");
      corners_.push_back(static_cast<Index>(value));
    }
    if (is_face) face_ends_.push_back(corners_.size());
  }

  /// After everything is read: vertices may come after the faces.
  void cut_faces() {
    const auto vertices = static_cast<Index>(file_.mesh.positions.size());
    std::vector<Vec3d> places;
    std::vector<Triangle> triangles;
    std::size_t begin = 0;
    for (std::size_t f = 0; f < face_ends_.size(); ++f) {
      const std::string where = "face " + std::to_string(f);

      // The cut works on places, and numbers of vertices can be checked only now.
      places.clear();
      for (std::size_t k = begin; k < face_ends_[f]; ++k) {
        const Index v = corners_[k];
        if (v >= vertices)
          refuse(where, std::to_string(v),
                 "the number of a vertex below " + std::to_string(vertices));
        places.push_back(file_.mesh.positions[static_cast<std::size_t>(v)]);
      }

      // The cut speaks of corners of the face, the mesh of vertices.
      triangles.clear();
      const std::string expected = cut_polygon(places, triangles);
      if (!expected.empty()) refuse(where, std::to_string(places.size()) + " corners", expected);
      if (file_.mesh.faces.size() + triangles.size() > kLargestCount)
        refuse(where, "one more", "at most 536870911 triangles");

      // Polygons are remembered, because a rest shape has to be cut in the same way.
      if (places.size() > 3)
        file_.polygons.push_back({static_cast<Index>(file_.mesh.faces.size()),
                                  static_cast<Index>(triangles.size()),
                                  {corners_.begin() + static_cast<std::ptrdiff_t>(begin),
                                   corners_.begin() + static_cast<std::ptrdiff_t>(face_ends_[f])}});

      const auto vertex = [&](Index c) { return corners_[begin + static_cast<std::size_t>(c)]; };
      for (const Triangle& t : triangles)
        file_.mesh.faces.push_back({vertex(t[0]), vertex(t[1]), vertex(t[2])});
      begin = face_ends_[f];
    }
  }

  std::string_view rest_;
  const std::string& path_;
  std::vector<Element> elements_;
  std::vector<Index> corners_;          ///< vertices of all faces, one after the other
  std::vector<std::size_t> face_ends_;  ///< end of each face in corners_
  MeshFile file_;
  Format format_ = Format::ascii;
  bool has_format_ = false;
};

}  // namespace

MeshFile parse_ply(std::string_view bytes, const std::string& path) {
  return PlyParser(bytes, path).parse();
}

void write_ply(const std::string& path, std::span<const NamedMesh> objects,
               const std::string& comment) {
  // A comment is the only place for what one mesh has no word for.
  std::ostringstream head;
  head << "ply\nformat binary_little_endian 1.0\n";
  if (!comment.empty()) head << "comment " << comment << "\n";
  std::size_t vertices = 0, faces = 0;
  for (const NamedMesh& object : objects) {
    head << "comment object " << file_line(object.name) << " " << vertices << " "
         << object.positions.size() << " " << faces << " " << object.faces.size() << "\n";
    vertices += object.positions.size();
    faces += object.faces.size();
  }
  head << "element vertex " << vertices
       << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << faces
       << "\nproperty list uchar int vertex_indices\nend_header\n";

  // Positions come first, then a face as its count of corners and their numbers.
  std::string text = head.str();
  text.reserve(text.size() + vertices * sizeof(Vec3f) + faces * 13);
  const auto add = [&text](const void* data, std::size_t bytes) {
    text.append(static_cast<const char*>(data), bytes);
  };
  for (const NamedMesh& object : objects)
    add(object.positions.data(), object.positions.size_bytes());
  std::int32_t first = 0;
  for (const NamedMesh& object : objects) {
    for (const Triangle& face : object.faces) {
      text += '\3';
      for (const Index v : face) {
        const std::int32_t corner = first + v;
        add(&corner, sizeof corner);
      }
    }
    first += static_cast<std::int32_t>(object.positions.size());
  }
  write_file(path, text);
}

}  // namespace icloth
