#include "sim/scene/repair_constraints.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/distance.h"
#include "kernels/index.h"
#include "sim/scene/box_tree.h"
#include "sim/scene/repair_hulls.h"
#include "sim/scene/repair_seams.h"

namespace icloth {
namespace {

constexpr double kSlack = 1.5;  ///< an edge under a ridge is deeper than its closest point tells

/// Marks: for each element the contours that it belongs to.
using Marks = std::vector<std::vector<Index>>;

bool common(const std::vector<Index>& a, const std::vector<Index>& b) {
  return std::ranges::any_of(a, [&](Index i) { return std::ranges::find(b, i) != b.end(); });
}

void mark(std::vector<Index>& marks, Index contour) {
  if (marks.empty() || marks.back() != contour) marks.push_back(contour);
}

class Collector {
 public:
  Collector(const RepairMesh& mesh, std::span<const SidedContour> contours, double offset,
            bool parted)
      : mesh_(mesh),
        contours_(contours),
        offset_(offset),
        parted_(parted),
        own_vertices_(mesh.x.size()),
        own_edges_(mesh.edges.size()),
        other_faces_(mesh.faces.size()),
        other_edges_(mesh.edges.size()),
        moving_(mesh.x.size(), 0) {}

  std::vector<GapConstraint> run() {
    // The parts of the sheets near each contour are found first, since edges need those of both
    // sheets.
    for (std::size_t c = 0; c < contours_.size(); ++c)
      if (contours_[c].side.sign != 0) add_vertices(c);
    for (std::size_t c = 0; c < contours_.size(); ++c)
      if (contours_[c].side.sign != 0) add_edges(c);
    for (std::size_t c = 0; c < contours_.size(); ++c)
      if (contours_[c].side.in_plane) add_borders(c);
    for (std::size_t c = 0; c < contours_.size(); ++c)
      if (norm2(contours_[c].side.apart) > 0) add_hulls(c);

    // When nothing crosses any more, the contours only tell what needs the whole offset.
    if (parted_) constraints_.clear();
    add_surroundings();
    return std::move(constraints_);
  }

 private:
  /// Faces around the wrong vertices and the contour, and the vertices of those.
  struct Region {
    std::vector<std::pair<Index, Index>> vertices;  ///< each with a face of the other sheet near it
    std::vector<Index> edges;
  };

  void add_vertices(std::size_t c) {
    const Contour& contour = contours_[c].contour;
    const Side& side = contours_[c].side;
    const auto number = static_cast<Index>(c);

    // The region on this sheet has the contour, the wrong vertices, and one ring of faces around
    // them.
    std::vector<std::pair<Index, Index>> seeds;
    for (const Contour::Segment& s : contour.segments)
      for (const Index v : mesh_.faces[at(s.own)]) seeds.emplace_back(v, s.other);
    for (const WrongVertex& w : side.wrong) seeds.emplace_back(w.vertex, w.face);
    Region& region = regions_.emplace_back();
    region_of_.push_back(c);
    for (const auto& [seed, near] : seeds)
      for (const Index f : mesh_.vertex_faces[seed]) {
        for (const Index v : mesh_.faces[at(f)])
          if (own_vertices_[at(v)].empty() || own_vertices_[at(v)].back() != number) {
            own_vertices_[at(v)].push_back(number);
            region.vertices.emplace_back(v, near);
          }
        for (const Index e : mesh_.face_edges[at(f)])
          if (own_edges_[at(e)].empty() || own_edges_[at(e)].back() != number) {
            own_edges_[at(e)].push_back(number);
            region.edges.push_back(e);
          }
      }

    // Each vertex goes by its height over the closest point of the other sheet.
    for (const Contour::Segment& s : contour.segments) mark_other(s.other, number);
    for (const auto& [v, near] : region.vertices) {
      const SurfacePoint p = walk_to_closest(mesh_, mesh_.position(v), near);
      mark_other(p.face, number);
      moving_[at(v)] = 1;
      const double gap = side.sign * p.height;
      if (p.beyond || !in_reach(gap, side.depth)) continue;
      const Triangle& t = mesh_.faces[at(p.face)];
      if (std::ranges::find(t, v) != t.end()) continue;
      add({{v, t[0], t[1], t[2]},
           {1, -p.w[0], -p.w[1], -p.w[2]},
           double(side.sign) * p.normal,
           offset_});
    }
  }

  /// Borders that belong beside each other.
  void add_borders(std::size_t c) {
    const Contour& own = contours_[c].contour;
    const Contour& twin = contours_[own.twin].contour;

    // The faces of the contour and one ring around them, on both sheets, go by the borders.
    for (const Contour::Segment& s : own.segments) {
      mark_other(s.other, static_cast<Index>(c));
      for (const Index v : mesh_.faces[at(s.own)])
        for (const Index f : mesh_.vertex_faces[v]) {
          for (const Index w : mesh_.faces[at(f)])
            mark(own_vertices_[at(w)], static_cast<Index>(c));
          for (const Index e : mesh_.face_edges[at(f)])
            mark(own_edges_[at(e)], static_cast<Index>(c));
        }
    }

    // A constraint holds for both sheets.
    if (own.twin < c) return;
    for (const GapConstraint& g : keep_beside(mesh_, own, twin, offset_)) add(g);
  }

  /// Faces that go apart as a whole.
  void add_hulls(std::size_t c) {
    const Contour& own = contours_[c].contour;

    // Only the faces that cross: those around them stay on the side on which they are.
    for (const Contour::Segment& s : own.segments) {
      mark(other_faces_[at(s.other)], static_cast<Index>(c));
      for (const Index e : mesh_.face_edges[at(s.other)])
        mark(other_edges_[at(e)], static_cast<Index>(c));
      for (const Index e : mesh_.face_edges[at(s.own)])
        mark(own_edges_[at(e)], static_cast<Index>(c));
      for (const Index v : mesh_.faces[at(s.own)]) {
        mark(own_vertices_[at(v)], static_cast<Index>(c));
        moving_[at(v)] = 1;
      }
    }

    // A constraint holds for both sheets.
    if (own.twin < c) return;
    for (const GapConstraint& g : keep_hulls_apart(mesh_, own, contours_[c].side.apart, offset_))
      add(g);
  }

  /// A face of the other sheet and those around it.
  void mark_other(Index face, Index contour) {
    for (const Index v : mesh_.faces[at(face)]) {
      moving_[at(v)] = 1;
      for (const Index f : mesh_.vertex_faces[v]) {
        mark(other_faces_[at(f)], contour);
        for (const Index e : mesh_.face_edges[at(f)]) mark(other_edges_[at(e)], contour);
      }
    }
  }

  bool in_reach(double gap, double depth) const {
    return gap >= -kSlack * depth - 0.1 * offset_ && gap < depth + 2 * offset_;
  }

  void add_edges(std::size_t c) {
    const SidedContour& own = contours_[c];
    const SidedContour& twin = contours_[own.contour.twin];
    if (twin.side.sign != 0 && own.contour.twin < c) return;  // done from there

    // A tree of the edges of the other sheet finds those that are near.
    std::vector<Index> others;
    std::vector<Box> boxes;
    for (std::size_t e = 0; e < mesh_.edges.size(); ++e) {
      const bool near =
          std::ranges::find(other_edges_[e], static_cast<Index>(c)) != other_edges_[e].end();
      if (!near) continue;
      others.push_back(static_cast<Index>(e));
      boxes.push_back(edge_box(static_cast<Index>(e)));
    }
    const BoxTree tree(boxes);
    const auto region = std::ranges::find(region_of_, c) - region_of_.begin();
    const double depth = std::max(own.side.depth, twin.side.sign != 0 ? twin.side.depth : 0.0);

    // An edge has to be on that side of the other edge on which its sheet has to be.
    for (const Index e : regions_[static_cast<std::size_t>(region)].edges)
      tree.visit(edge_box(e).grown(kSlack * depth + 2 * offset_), [&](Index i) {
        add_crossing_edges(e, others[at(i)], own.side.sign, twin.side.sign, depth);
      });
  }

  /// Edge e of a sheet that belongs on the side `sign` of edge f; where `twin_sign` is not 0, f
  /// belongs on that side of e.
  void add_crossing_edges(Index e, Index f, int sign, int twin_sign, double depth) {
    const auto [a, b] = mesh_.edges[at(e)];
    const auto [c, d] = mesh_.edges[at(f)];
    if (a == c || a == d || b == c || b == d) return;

    // The edges have to pass each other within both of them.
    const Vec3d u = mesh_.position(b) - mesh_.position(a);
    const Vec3d v = mesh_.position(d) - mesh_.position(c);
    const Vec3d from = mesh_.position(c) - mesh_.position(a), n = cross(u, v);
    const double nn = norm2(n);
    if (!(nn > 1e-6 * norm2(u) * norm2(v))) return;
    const double s = dot(cross(from, v), n) / nn, r = dot(cross(from, u), n) / nn;
    if (!(s > 0 && s < 1 && r > 0 && r < 1)) return;

    // The common normal points from f to where e has to be.
    Vec3d normal = normalized(n);
    if (dot(normal, double(sign) * mesh_.edge_normal(f)) < 0) normal = -normal;
    if (!in_reach(-dot(normal, from), depth) || !in_cone(f, double(sign) * normal)) return;
    if (twin_sign != 0 && !in_cone(e, double(-twin_sign) * normal)) return;
    add({{a, b, c, d}, {1 - s, s, r - 1, -r}, normal, offset_});
  }

  /// Whether a direction lies between the normals of the faces of an edge, or close to that: only
  /// there another edge can lie on this one.
  bool in_cone(Index edge, Vec3d direction) const {
    constexpr double slack = 0.44, border = 1.13, most = 1.48;  // radians
    const Vec3d middle = normalized(mesh_.edge_normal(edge));
    const auto faces = mesh_.edge_faces[edge];
    double half = faces.size() < 2 ? border : 0;
    for (const Index f : faces)
      half = std::max(half, std::acos(std::clamp(dot(middle, mesh_.normal(f)), -1.0, 1.0)));
    return dot(direction, middle) >= std::cos(std::min(half + slack, most));
  }

  /// Everything else close to what moves stays on its side.
  void add_surroundings() {
    double reach = 0;
    for (const SidedContour& c : contours_)
      if (c.side.decided()) reach = std::max(reach, c.side.depth);
    reach = 1.25 * reach + 3 * offset_;

    // The vertices that may move have one ring more than the regions.
    std::vector<std::uint8_t> moving = moving_;
    for (const Triangle& t : mesh_.faces)
      if (std::ranges::any_of(t, [&](Index v) { return moving_[at(v)] != 0; }))
        for (const Index v : t) moving[at(v)] = 1;

    // A pair is looked for from its moving element, or from the first one of two.
    std::vector<Box> vertex_boxes, edge_boxes, face_boxes;
    for (const Vec3d& p : mesh_.x) vertex_boxes.push_back({p, p});
    for (std::size_t e = 0; e < mesh_.edges.size(); ++e)
      edge_boxes.push_back(edge_box(static_cast<Index>(e)));
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
      face_boxes.emplace_back();
      for (const Vec3d& p : mesh_.corners(static_cast<Index>(f))) face_boxes.back().add(p);
    }
    const BoxTree vertices(vertex_boxes), edges(edge_boxes), faces(face_boxes);
    const auto moves = [&](const auto& element) {
      return std::ranges::any_of(element, [&](Index v) { return moving[at(v)] != 0; });
    };

    // Vertices that move are held against all faces, and other vertices only against faces that
    // move.
    for (std::size_t v = 0; v < mesh_.x.size(); ++v)
      if (moving[v])
        faces.visit(vertex_boxes[v].grown(reach),
                    [&](Index f) { keep_vertex(static_cast<Index>(v), f, reach); });
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f)
      if (moves(mesh_.faces[f]))
        vertices.visit(face_boxes[f].grown(reach), [&](Index v) {
          if (!moving[at(v)]) keep_vertex(v, static_cast<Index>(f), reach);
        });
    for (std::size_t e = 0; e < mesh_.edges.size(); ++e)
      if (moves(mesh_.edges[e]))
        edges.visit(edge_boxes[e].grown(reach), [&](Index f) {
          if (at(f) < e || !moves(mesh_.edges[at(f)])) keep_edges(static_cast<Index>(e), f, reach);
        });
  }

  /// A vertex on its side of a face.
  void keep_vertex(Index v, Index face, double reach) {
    const Triangle& t = mesh_.faces[at(face)];
    const bool crossed = common(own_vertices_[at(v)], other_faces_[at(face)]);
    if (std::ranges::find(t, v) != t.end() || (crossed && !parted_)) return;
    const auto closest = [&](const std::vector<Vec3d>& x) {
      return closest_point_triangle(x[at(v)], x[at(t[0])], x[at(t[1])], x[at(t[2])]);
    };
    const TrianglePoint<double> p = closest(mesh_.x);
    if (!(p.distance2 < reach * reach) || is_told_elsewhere(face, p)) return;
    keep({{v, t[0], t[1], t[2]}, {1, -p.w[0], -p.w[1], -p.w[2]}, {}, 0},
         crossed ? offset_ : room(v, t[0], closest(mesh_.start).distance2));
  }

  /// Whether another face is the first one with the edge or vertex on which the closest point lies.
  bool is_told_elsewhere(Index face, const TrianglePoint<double>& p) const {
    const auto zeros = std::ranges::count(p.w, 0.0);
    if (zeros == 0) return false;
    if (zeros == 2) {
      const auto corner = static_cast<std::size_t>(std::ranges::max_element(p.w) - p.w);
      return mesh_.vertex_faces[mesh_.faces[at(face)][corner]].front() != face;
    }
    const auto opposite = static_cast<std::size_t>(std::ranges::find(p.w, 0.0) - p.w);
    return mesh_.edge_faces[mesh_.face_edges[at(face)][(opposite + 1) % 3]].front() != face;
  }

  /// An edge on its side of another one.
  void keep_edges(Index e, Index f, double reach) {
    const auto [a, b] = mesh_.edges[at(e)];
    const auto [c, d] = mesh_.edges[at(f)];
    if (a == c || a == d || b == c || b == d) return;
    const bool crossed = common(own_edges_[at(e)], other_edges_[at(f)]) ||
                         common(own_edges_[at(f)], other_edges_[at(e)]);
    if (crossed && !parted_) return;
    const auto closest = [&, v = std::array{a, b, c, d}](const std::vector<Vec3d>& x) {
      return closest_points_segments(x[at(v[0])], x[at(v[1])], x[at(v[2])], x[at(v[3])]);
    };
    const SegmentPoints<double> p = closest(mesh_.x);
    if (!(p.distance2 < reach * reach)) return;
    keep({{a, b, c, d}, {1 - p.s, p.s, p.t - 1, -p.t}, {}, 0},
         crossed ? offset_ : room(a, c, closest(mesh_.start).distance2));
  }

  /// Gap that a pair without a contour needs: between parts the offset, once nothing crosses any
  /// more; else, and in one sheet, no more than at the start.
  double room(Index v, Index w, double start_distance2) const {
    if (parted_ && mesh_.part[at(v)] != mesh_.part[at(w)]) return offset_;
    return std::min(offset_, std::sqrt(start_distance2));
  }

  void keep(GapConstraint constraint, double target) {
    Vec3d gap;
    for (std::size_t k = 0; k < 4; ++k) gap += constraint.w[k] * mesh_.position(constraint.v[k]);
    if (!(norm2(gap) > 1e-18)) return;  // in touch: no side is known
    constraint.n = normalized(gap);
    constraint.target = target;
    add(constraint);
  }

  void add(const GapConstraint& constraint) {
    const auto moves = [&](std::size_t k) {
      return constraint.w[k] != 0 && mesh_.is_free(constraint.v[k]);
    };
    if (moves(0) || moves(1) || moves(2) || moves(3)) constraints_.push_back(constraint);
  }

  Box edge_box(Index e) const {
    Box box;
    for (const Index v : mesh_.edges[at(e)]) box.add(mesh_.position(v));
    return box;
  }

  const RepairMesh& mesh_;
  std::span<const SidedContour> contours_;
  double offset_;
  bool parted_;
  Marks own_vertices_, own_edges_, other_faces_, other_edges_;
  std::vector<std::uint8_t> moving_;
  std::vector<Region> regions_;
  std::vector<std::size_t> region_of_;  ///< contour of each region
  std::vector<GapConstraint> constraints_;
};

}  // namespace

std::vector<GapConstraint> collect_constraints(const RepairMesh& mesh,
                                               std::span<const SidedContour> contours,
                                               double offset, bool parted) {
  return Collector(mesh, contours, offset, parted).run();
}

double gap_of(const RepairMesh& mesh, const GapConstraint& constraint) {
  Vec3d gap;
  for (std::size_t k = 0; k < 4; ++k) gap += constraint.w[k] * mesh.position(constraint.v[k]);
  return dot(constraint.n, gap);
}

}  // namespace icloth
