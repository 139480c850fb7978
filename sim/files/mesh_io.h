// The project's own readers and writers of meshes; they keep the order of the vertices.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/files/mesh.h"

namespace icloth {

/// Object of a mesh file: a `g` group of an OBJ, or the whole file.
struct MeshGroup {
  std::string name;
  Index first_face = 0, face_count = 0;
};

/// Face of a file with more than three corners.
struct FilePolygon {
  Index first_face = 0, face_count = 0;  ///< triangles that it was cut into
  std::vector<Index> corners;            ///< its vertices in order
  bool operator==(const FilePolygon&) const = default;
};

struct MeshFile {
  TriangleMesh mesh;
  std::vector<MeshGroup> groups;      ///< at least one
  std::vector<FilePolygon> polygons;  ///< in the order of their triangles
};

/// OBJ or PLY by extension; polygons are cut into triangles (sim/files/polygon.h). Throws
/// InputError naming file, line and value: missing or truncated file, non-finite number, index out
/// of range, no triangles.
MeshFile read_mesh(const std::string& path);

/// Throws InputError naming the first face of a cloth without area or with a repeated vertex.
void check_cloth_mesh(const TriangleMesh& mesh, const std::string& name);

/// Faces that may share an edge of a cloth: every two of them resist bending against each other, so
/// time and memory grow with their square.
inline constexpr std::size_t kMostFacesOnEdge = 16;
/// Faces that may share a vertex of a cloth: all of them are near each other, so that time and
/// memory of collision tests grow with the square of their number.
inline constexpr std::size_t kMostFacesAtVertex = 4096;

/// Throws InputError naming the first edge of a cloth with more than kMostFacesOnEdge faces, or the
/// vertex with most of them, if it has more than kMostFacesAtVertex.
/// `numbers` are the vertices as the file counts them; empty: as the mesh does.
void check_edges(const TriangleMesh& mesh, const std::string& name,
                 std::span<const Index> numbers = {});

/// Positions of a mesh over time.
struct PointCache {
  std::vector<std::vector<Vec3f>> frames;  ///< (frames)(V) [m], at least one frame
  double frame_rate = 0;                   ///< [1/s]; 0: the file does not say
  std::vector<std::string> unused;         ///< parts of the file that are not used, a clause each
};

/// PC2 or MDD by extension. `vertices` is the expected count (checked before memory is taken).
/// Throws InputError naming file, frame, vertex and value.
PointCache read_point_cache(const std::string& path, Index vertices);

struct NamedMesh {
  std::string name;  ///< "cloth:NAME" or "obstacle:NAME"
  std::span<const Vec3f> positions;
  std::span<const Triangle> faces;  ///< indices into positions
  /// Texture coordinates of the corners of the faces, where the mesh has them. Formats of a
  /// single frame leave them out unless they are asked for.
  std::span<const std::array<Vec2d, 3>> uv = {};
};

/// Whether an OBJ file has the texture coordinates of its objects.
enum class ObjUv { left_out, written };

/// One group per object, coordinates with 9 significant digits; written beside and renamed. The
/// comment is the first line.
void write_obj(const std::string& path, std::span<const NamedMesh> objects,
               const std::string& comment = "", ObjUv uv = ObjUv::left_out);

/// One mesh of all objects, binary, little endian: positions in single precision, bit for bit. A
/// comment for each object gives its name and its first and number of vertices and faces.
void write_ply(const std::string& path, std::span<const NamedMesh> objects,
               const std::string& comment = "");

/// A cloth with material coordinates: `v` with 9 significant digits, `vt` with 12 in metres, one
/// group for each run of faces of one piece. `piece` (F) are numbers in `names`.
void write_cloth_obj(const std::string& path, const TriangleMesh& mesh,
                     std::span<const Index> piece, std::span<const std::string> names,
                     const std::string& comment);

}  // namespace icloth
