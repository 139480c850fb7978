#include "sim/mechanics/plates.h"

#include <cmath>

#include "kernels/index.h"

namespace icloth {
namespace {

using Row = std::array<double, 3>;  // factors of H_uu, H_vv, H_uv, or of three hinges

/// Larger than this against the mid-edge operator, W would amplify single angles.
constexpr double kLargestGain = 4;
/// Shares of the mid-edge operator that are tried in turn.
constexpr double kShares[] = {0.5, 0.75, 1.0};

/// Corners of a face in its material axes, the first at the origin.
std::array<Vec2d, 3> corners(const std::array<double, 4>& inverse) {
  const double det = inverse[0] * inverse[3] - inverse[1] * inverse[2];
  return {Vec2d{0, 0}, Vec2d{inverse[3] / det, -inverse[2] / det},
          Vec2d{-inverse[1] / det, inverse[0] / det}};
}

/// Place of a vertex over an edge: along it from its start, and off it.
struct Flap {
  double along, height;
};

struct FlatEdge {
  Vec2d direction, outward;  ///< unit vectors in the material axes of the face
  double length = 0;
  Flap own;  ///< the face's third corner
};

FlatEdge flat_edge(const std::array<Vec2d, 3>& p, std::size_t corner) {
  const Vec2d a = p[corner], b = p[(corner + 1) % 3], c = p[(corner + 2) % 3];
  FlatEdge e;
  e.length = std::hypot(b.x - a.x, b.y - a.y);
  e.direction = (1 / e.length) * (b - a);
  e.outward = {e.direction.y, -e.direction.x};

  // The third corner gives the height of the face and tells which side is outward.
  const Vec2d d = c - a;
  e.own.along = d.x * e.direction.x + d.y * e.direction.y;
  const double off = d.x * e.outward.x + d.y * e.outward.y;
  if (off > 0) e.outward = -1.0 * e.outward;  // material axes may be mirrored
  e.own.height = std::fabs(off);
  return e;
}

/// aᵀ H b as factors of H_uu, H_vv, H_uv.
Row bilinear(Vec2d a, Vec2d b) { return {a.x * b.x, a.y * b.y, a.x * b.y + a.y * b.x}; }

/// Angle of a hinge over z = ½ pᵀ H p: the difference of the slopes across the edge on both sides.
Row hinge_angle_of_quadratic(const FlatEdge& e, Flap other) {
  const double across = (e.own.height + other.height) / 2;
  const double twist = other.along - e.own.along;
  const double along = -(e.own.along * (e.length - e.own.along) / e.own.height +
                         other.along * (e.length - other.along) / other.height) /
                       2;

  const Row nn = bilinear(e.outward, e.outward), sn = bilinear(e.direction, e.outward),
            ss = bilinear(e.direction, e.direction);
  Row m;
  for (std::size_t k = 0; k < 3; ++k) m[k] = across * nn[k] + twist * sn[k] + along * ss[k];
  return m;
}

Row cross3(const Row& a, const Row& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot3(const Row& a, const Row& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

using Matrix = std::array<Row, 3>;

Matrix inverse(const Matrix& m) {
  const Row c[3] = {cross3(m[1], m[2]), cross3(m[2], m[0]), cross3(m[0], m[1])};
  const double det = dot3(m[0], c[0]);
  Matrix out;
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t k = 0; k < 3; ++k) out[r][k] = c[k][r] / det;
  return out;
}

/// W with the smallest H:H among the curvatures H that give the angles of the hinges that exist.
/// When all three exist, it is the inverse of m.
Matrix curvature_from_angles(const Matrix& m, const std::array<Index, 3>& hinge) {
  constexpr double kInverseWeight[3] = {1, 1, 0.5};  // H:H = H_uu² + H_vv² + 2 H_uv²

  // Least squares with Q the inverse weights: W = Q mᵀ (m Q mᵀ)⁻¹ over the rows of those hinges.
  // The rows of missing hinges are those of the identity, so that the matrix can be inverted.
  Matrix gram{};
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 3; ++b) {
      if (hinge[a] < 0 || hinge[b] < 0) {
        gram[a][b] = a == b ? 1 : 0;
        continue;
      }
      for (std::size_t k = 0; k < 3; ++k) gram[a][b] += m[a][k] * kInverseWeight[k] * m[b][k];
    }
  const Matrix solve = inverse(gram);

  Matrix w{};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t b = 0; b < 3; ++b)
      for (std::size_t a = 0; a < 3; ++a)
        if (hinge[a] >= 0 && hinge[b] >= 0) w[k][b] += kInverseWeight[k] * m[a][k] * solve[a][b];
  return w;
}

/// Σ of squares of middle · w: how much larger w is than the mid-edge operator.
double gain2(const Matrix& middle, const Matrix& w) {
  double sum = 0;
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 3; ++b) {
      double entry = 0;
      for (std::size_t k = 0; k < 3; ++k) entry += middle[a][k] * w[k][b];
      sum += entry * entry;
    }
  return sum;
}

/// W of a face from the angles of quadratics on its three edges.
std::array<double, 9> plate_operator(const std::array<FlatEdge, 3>& edges, double area,
                                     const Matrix& exact, const FacePlate& plate) {
  // The mid-edge operator follows from the edges of the face alone.
  Matrix middle_w;
  for (std::size_t a = 0; a < 3; ++a) {
    const Vec2d n = edges[a].outward;
    const double scale = edges[a].length / (2 * area);
    middle_w[0][a] = scale * n.x * n.x;
    middle_w[1][a] = scale * n.y * n.y;
    middle_w[2][a] = scale * n.x * n.y;
  }
  const Matrix middle = inverse(middle_w);

  // The exact operator is mixed in with the smallest share that does not amplify single angles.
  Matrix w{};
  for (const double share : kShares) {
    Matrix m;
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t k = 0; k < 3; ++k)
        m[a][k] = (1 - share) * exact[a][k] + share * middle[a][k];
    w = curvature_from_angles(m, plate.hinge);
    if (gain2(middle, w) <= kLargestGain * kLargestGain) break;
  }

  std::array<double, 9> out;
  for (std::size_t i = 0; i < 9; ++i) out[i] = w[i / 3][i % 3];
  return out;
}

/// One edge of a face and the face on its other side.
struct Side {
  Index hinge = -1;
  double sign = 1;
  Flap other{};  ///< the neighbour's third corner, from the start of this face's edge
};

std::size_t corner_of(const Triangle& t, Index vertex) {
  return t[0] == vertex ? 0 : (t[1] == vertex ? 1 : 2);
}

}  // namespace

std::vector<FacePlate> make_plates(const World& world) {
  const std::size_t faces = at(world.cloth_faces);
  std::vector<std::array<FlatEdge, 3>> edges(faces);
  for (std::size_t f = 0; f < faces; ++f) {
    const std::array<Vec2d, 3> p = corners(world.face_inverse[f]);
    for (std::size_t a = 0; a < 3; ++a) edges[f][a] = flat_edge(p, a);
  }

  // Each hinge tells both of its faces where the third corner of the other one is at rest.
  std::vector<std::array<Side, 3>> sides(faces);
  for (std::size_t h = 0; h < world.hinges.size(); ++h) {
    const Hinge& hinge = world.hinges[h];
    if (hinge.weight != 1) continue;
    const std::size_t f0 = at(hinge.face0), f1 = at(hinge.face1);
    const Triangle &t0 = world.face[f0], &t1 = world.face[f1];
    const std::size_t a0 = corner_of(t0, hinge.vertices[0]);
    const std::size_t opposite = corner_of(t1, hinge.vertices[3]), a1 = (opposite + 1) % 3;

    // Neighbours that are oriented alike run along their edge in opposite directions.
    const bool alike = t1[a1] != t0[a0];
    const FlatEdge &e0 = edges[f0][a0], &e1 = edges[f1][a1];

    // The places of the third corners, seen from the start of this face's edge.
    const auto seen = [&](const FlatEdge& e) {
      return Flap{alike ? e.length - e.own.along : e.own.along, e.own.height};
    };
    sides[f0][a0] = {static_cast<Index>(h), 1.0, seen(e1)};
    sides[f1][a1] = {static_cast<Index>(h), alike ? 1.0 : -1.0, seen(e0)};
  }

  // The operator of each face takes the angles of its hinges with the sign of its own side.
  std::vector<FacePlate> plates(faces);
  for (std::size_t f = 0; f < faces; ++f) {
    Matrix exact{};
    for (std::size_t a = 0; a < 3; ++a) {
      plates[f].hinge[a] = sides[f][a].hinge;
      if (sides[f][a].hinge >= 0)
        exact[a] = hinge_angle_of_quadratic(edges[f][a], sides[f][a].other);
    }
    plates[f].w = plate_operator(edges[f], world.face_area[f], exact, plates[f]);
    for (std::size_t i = 0; i < 9; ++i) plates[f].w[i] *= sides[f][i % 3].sign;
  }

  return plates;
}

}  // namespace icloth
