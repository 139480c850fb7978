// The elementary CCD where a face or an edge collapses: random cases in which the volume passes
// through zero because a face shrinks to a line or a point, an edge to a point, or two edges become
// parallel. All numbers are integers times a power of two, so that a contact that is built in
// happens exactly; that there is none is proved by subdivision (oracle/certified_ccd.h).
#include "kernels/ccd/ccd_collapse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>

#include "kernels/ccd/elementary_ccd.h"
#include "tests/oracle/certified_ccd.h"
#include "tests/oracle/slow_ccd.h"

namespace icloth {
namespace {

using Query = CcdQuery<double>;
using Integer = std::int64_t;
using Point = Vec3<Integer>;

/// What happens to the primitives at the time of collapse.
enum class Shape { edge_to_point, face_to_segment, to_point, both_to_points, parallel, count };

/// How the primitives lie then.
enum class Place { anywhere, touching, close, count };

/// A query, the time of its collapse, and whether its primitives touch exactly then.
struct Case {
  PairKind kind{};
  Query query;
  double time{};
  bool touches{};
  double extent{};  // largest |coordinate|
};

class Generator {
 public:
  /// Coordinates are multiples of 16 up to `cells` · 16 before the rotation.
  Generator(unsigned seed, Integer cells) : random_(seed), cells_(cells) {}

  Case make(PairKind kind, Shape shape, Place place) {
    // The four points lie in a plane x = 0 in most cases, which they pass by motions along x (paths
    // 1) or mirrored ones (paths 2): then the collapse leaves one primitive above the other.
    Point x[4];
    for (Point& p : x) p = point(16);
    const Integer paths = pick(3);
    if (paths > 0) {
      for (Point& p : x) p.x = 0;
    }

    // The points at the time of collapse, which is not complete where they are blurred.
    kind == PairKind::vf ? collapse_face(shape, x) : collapse_edges(shape, x);
    const bool exact = place == Place::touching;
    if (!exact && pick(3) == 0) blur(x);
    if (place != Place::anywhere) bring_together(kind, x);
    if (place == Place::close) x[0] += Point{offset(), offset(), offset()};

    // Linear motions through these points, a similarity that is exact in integers, and a power of
    // two as the scale.
    const Integer quarters = 1 + pick(3);
    const double scale = std::ldexp(1.0, static_cast<int>(pick(41)) - 40);
    choose_rotation();
    Case out{kind, {}, static_cast<double>(quarters) / 4, exact, 0};
    const Point shift = pick(2) == 0 ? point(16) : Point{};
    const Point common = point(4);
    for (int k = 0; k < 4; ++k) {
      Point motion = point(4);
      if (pick(6) == 0) motion = {};
      if (paths == 1) motion = {motion.x, common.y, common.z};
      if (paths == 2) motion = mirror_motion(kind, k, motion);
      out.query.p0[k] = placed(x[k] - quarters * motion + shift, scale);
      out.query.p1[k] = placed(x[k] + (4 - quarters) * motion + shift, scale);
      out.extent = std::max({out.extent, norm_max(out.query.p0[k]), norm_max(out.query.p1[k])});
    }
    return out;
  }

  Integer pick(Integer n) {
    return static_cast<Integer>(random_() % static_cast<std::uint64_t>(n));
  }

 private:
  /// A random point whose coordinates are multiples of `unit`.
  Point point(Integer unit) {
    const auto coordinate = [&] { return unit * (pick(2 * cells_ + 1) - cells_); };
    return {coordinate(), coordinate(), coordinate()};
  }
  Integer offset() { return pick(3) - 1; }

  /// A point of the segment between two points, at a quarter of its length.
  Point between(Point a, Point b) {
    const Integer s = pick(5);
    return {a.x + s * ((b.x - a.x) / 4), a.y + s * ((b.y - a.y) / 4), a.z + s * ((b.z - a.z) / 4)};
  }

  void collapse_face(Shape shape, Point* x) {
    const int first = pick(3) != 0 ? 1 : 1 + static_cast<int>(pick(3));
    Point &a = x[first], &b = x[1 + first % 3], &c = x[1 + (first + 1) % 3];
    if (shape == Shape::edge_to_point) b = a;
    if (shape == Shape::face_to_segment || shape == Shape::parallel) b = between(a, c);
    if (shape == Shape::to_point || shape == Shape::both_to_points) b = c = a;
  }

  void collapse_edges(Shape shape, Point* x) {
    if (shape == Shape::edge_to_point || shape == Shape::to_point) {
      const int k = pick(3) != 0 ? 0 : 2;
      x[k + 1] = x[k];
    } else if (shape == Shape::both_to_points) {
      x[1] = x[0];
      x[3] = x[2];
    } else {  // parallel, in either sense
      const Integer factor = pick(2) == 0 ? 1 : -1;
      x[3] = x[2] + Point{factor * (x[1].x - x[0].x), factor * (x[1].y - x[0].y),
                          factor * (x[1].z - x[0].z)};
    }
  }

  /// Moves points by one cell, so that the collapse is not complete.
  void blur(Point* x) {
    for (int k = 0; k < 4; ++k) x[k] += Point{offset(), offset(), offset()};
  }

  /// Moves the first primitive so that it touches the second one, exactly unless blurred.
  void bring_together(PairKind kind, Point* x) {
    if (kind == PairKind::vf) {
      const int k = static_cast<int>(pick(3));
      x[0] = between(x[1 + k], x[1 + (k + 1) % 3]);
      return;
    }
    const Point shift = between(x[2], x[3]) - between(x[0], x[1]);
    x[0] += shift;
    x[1] += shift;
  }

  /// Motions that mirror two points, of the face or of the first edge, in the plane x = 0, in which
  /// the others stay.
  Point mirror_motion(PairKind kind, int k, Point motion) {
    const int a = kind == PairKind::vf ? 1 : 0;
    if (k == a) mirrored_ = motion;
    if (k == a + 1) return {-mirrored_.x, mirrored_.y, mirrored_.z};
    return k == a ? motion : Point{0, motion.y, motion.z};
  }

  /// A rotation times the norm of an integer quaternion.
  void choose_rotation() {
    Integer w = pick(7) - 3, x = pick(7) - 3, y = pick(7) - 3, z = pick(7) - 3;
    if (w == 0 && x == 0 && y == 0 && z == 0) w = 1;
    if (pick(4) == 0) {
      w = 1;
      x = y = z = 0;
    }
    rotation_[0] = {w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)};
    rotation_[1] = {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)};
    rotation_[2] = {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z};
  }
  Vec3d placed(Point p, double scale) const {
    return {scale * static_cast<double>(dot(rotation_[0], p)),
            scale * static_cast<double>(dot(rotation_[1], p)),
            scale * static_cast<double>(dot(rotation_[2], p))};
  }

  std::mt19937_64 random_;
  Integer cells_;
  Point rotation_[3], mirrored_;
};

template <class T>
bool ccd(PairKind kind, const CcdQuery<T>& q, CcdHit& hit) {
  return kind == PairKind::vf ? ccd_vf(q, 0, hit) : ccd_ee(q, 0, hit);
}

/// The query in single precision; false when that is another query.
bool to_float(const Query& q, CcdQuery<float>& out) {
  bool exact = true;
  for (int k = 0; k < 4; ++k) {
    out.p0[k] = convert<float>(q.p0[k]);
    out.p1[k] = convert<float>(q.p1[k]);
    exact = exact && convert<double>(out.p0[k]) == q.p0[k];
    exact = exact && convert<double>(out.p1[k]) == q.p1[k];
  }
  return exact;
}

double distance_at(const Case& c, double time) {
  return static_cast<double>(oracle::distance_at(c.kind, c.query, time));
}

/// Length of the gap of the reported weights at the reported time.
double reported_gap(const Case& c, const CcdHit& hit) {
  Vec3d gap;
  for (int k = 0; k < 4; ++k) {
    gap += hit.w[k] * ((1 - hit.toi) * c.query.p0[k] + hit.toi * c.query.p1[k]);
  }
  return norm(gap);
}

/// What came of many cases.
struct Counts {
  long hits = 0, misses = 0, exact_in_float = 0;
  long undecided = 0;           // false positives in single precision at a distance
  long misses_by_a_little = 0;  // only quadruple precision proves them,
  long unproved = 0;            // or not even that: edges that turn at a gap of 1e-8 or less
};

/// Compares the answer with the contact that is built in, and with the proof.
void check(const Case& c, Counts& counts) {
  CcdHit hit;
  const bool is_hit = ccd(c.kind, c.query, hit);
  if (c.touches) {
    ASSERT_TRUE(is_hit) << "a contact was missed";
    ASSERT_LE(hit.toi, c.time) << "late";
  }

  // A miss has to be proved, but for a few. A contact has to be one, at the reported time and
  // between the reported points.
  const bool apart = oracle::certainly_apart(c.kind, c.query);
  counts.hits += is_hit;
  counts.misses += !is_hit;
  if (is_hit) {
    ASSERT_FALSE(apart) << "a false positive at a distance of " << distance_at(c, hit.toi);
    ASSERT_LE(distance_at(c, hit.toi), 1e-6 * c.extent) << "early";
    ASSERT_LE(reported_gap(c, hit), 1e-5 * c.extent) << "weights of other points";
    ASSERT_NEAR(norm(hit.normal), 1, 1e-12);
  } else if (!apart) {
    ++counts.misses_by_a_little;
    counts.unproved += !oracle::certainly_apart_by_a_little(c.kind, c.query);
  }

  // Single precision is decided without double-double arithmetic. Where it takes too many steps,
  // which are edges that turn in the plane of the other primitive, it is left at a contact.
  CcdQuery<float> single;
  if (!to_float(c.query, single)) return;
  ++counts.exact_in_float;
  CcdHit other;
  const bool is_other = ccd(c.kind, single, other);
  ASSERT_TRUE(is_other || !is_hit) << "a contact was missed in single precision";
  if (c.touches) {
    ASSERT_LE(other.toi, c.time) << "late in single precision";
  }
  if (is_other && apart && distance_at(c, other.toi) > 1e-9 * c.extent) ++counts.undecided;
}

// ---- collapses made by hand ---------------------------------------------------------------------

/// The face `corner` at t = 0, its points multiplied by `end` componentwise at t = 1, and a vertex
/// that moves along z.
Query face_below(const Vec3d* corner, Vec3d end, double z0, double z1) {
  Query q;
  q.p0[0] = {0, 0, z0};
  q.p1[0] = {0, 0, z1};
  for (int k = 0; k < 3; ++k) {
    q.p0[k + 1] = corner[k];
    q.p1[k + 1] = {end.x * corner[k].x, end.y * corner[k].y, end.z * corner[k].z};
  }
  return q;
}

const Vec3d kAround[3] = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};  // around the origin
const Vec3d kToLine{-1, 1, 1}, kToOtherLine{1, -1, 1}, kToPoint{-1, -1, 1};

/// Three times the query turned so that no coordinate axis separates it.
Query turned(Query q) {
  const auto turn = [](Vec3d& x) {
    x = {x.x + 2 * x.y + 2 * x.z, 2 * x.x + x.y - 2 * x.z, 2 * x.x - 2 * x.y + x.z};
  };
  for (int k = 0; k < 4; ++k) {
    turn(q.p0[k]);
    turn(q.p1[k]);
  }
  return q;
}

void expect_miss(PairKind kind, const Query& axis_parallel) {
  const Query q = turned(axis_parallel);
  CcdHit hit;
  EXPECT_FALSE(ccd(kind, q, hit)) << "toi " << hit.toi;
  CcdQuery<float> single;
  ASSERT_TRUE(to_float(q, single));
  EXPECT_FALSE(ccd(kind, single, hit)) << "in single precision, toi " << hit.toi;
}

TEST(CcdCollapse, FaceCollapsesBelowAVertex) {
  // The volume changes its sign at t = ½, or touches zero, with the vertex half an edge above.
  for (const Vec3d& end : {kToLine, kToOtherLine, kToPoint}) {
    expect_miss(PairKind::vf, face_below(kAround, end, 0.5, 0.5));
    expect_miss(PairKind::vf, face_below(kAround, end, 1, 0x1p-10));
  }
}

TEST(CcdCollapse, EdgesCollapseOrTurnParallel) {
  // An edge shrinks to a point and opens to the other side, above the middle of the other one; then
  // both do at once; then two edges turn past being parallel.
  for (const double size : {0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 5.0}) {
    const Vec3d x{1, 0, 0}, end = size * x, y{0, 1, 0.5}, low{0, -1, 0.5};
    const Vec3d up{size, size, 0.5}, down{-size, -size, 0.5};
    expect_miss(PairKind::ee, Query{{-x, x, low, y}, {end, -end, low, y}});
    expect_miss(PairKind::ee, Query{{low, y, -x, x}, {low, y, end, -end}});
    expect_miss(PairKind::ee, Query{{-x, x, low, y}, {end, -end, y, low}});
    expect_miss(PairKind::ee, Query{{-x, x, {-1, 1, 0.5}, {1, -1, 0.5}}, {-end, end, down, up}});
  }
}

TEST(CcdCollapse, ContactAfterTheCollapseIsFoundAtItsTime) {
  // The face has opened again when the vertex reaches it at t = ¾.
  for (const Vec3d& end : {kToLine, kToOtherLine, kToPoint}) {
    CcdHit hit;
    ASSERT_TRUE(ccd(PairKind::vf, face_below(kAround, end, 0.75, -0.25), hit));
    EXPECT_NEAR(hit.toi, 0.75, 1e-12);
    EXPECT_LE(hit.toi, 0.75);
    EXPECT_NEAR(norm(hit.normal - Vec3d{0, 0, 1}), 0, 1e-9);
  }
}

TEST(CcdCollapse, ContactAtTheCollapseIsFound) {
  for (const Vec3d& end : {kToLine, kToOtherLine, kToPoint}) {
    const Case c{PairKind::vf, face_below(kAround, end, 0.5, -0.5), 0.5, true, 1};
    Counts counts;
    check(c, counts);
  }
}

TEST(CcdCollapse, EdgeTurnsClosePastAPointInItsPlane) {
  // The edge of the face turns by 90° about a point 2⁻¹³ beside the vertex, all in one plane.
  for (const double gap : {0x1p-4, 0x1p-13, 0x1p-20}) {
    const Query q{{{0, 0, 0}, {-1, gap + 1, 0}, {1, gap - 1, 0}, {0, 3, 0}},
                  {{0, 0, 0}, {-1, gap - 1, 0}, {1, gap + 1, 0}, {0, 3, 0}}};
    CcdHit hit;
    EXPECT_FALSE(ccd_vf(q, 0, hit)) << "gap " << gap << ", toi " << hit.toi;
  }
}

// ---- random collapses ---------------------------------------------------------------------------

TEST(CcdCollapse, RandomCasesAgreeWithTheProof) {
  // The coarse grids give coincidences, the fine ones collapses that are not complete.
  Counts counts;
  for (const int bits : {3, 6, 10, 24, 36}) {
    Generator generator(static_cast<unsigned>(bits), Integer{1} << bits);
    for (int k = 0; k < 3000; ++k) {
      const PairKind kind = k % 2 == 0 ? PairKind::vf : PairKind::ee;
      const auto shape = static_cast<Shape>(k / 2 % static_cast<int>(Shape::count));
      const auto place = static_cast<Place>(k / 10 % static_cast<int>(Place::count));
      check(generator.make(kind, shape, place), counts);
      if (HasFatalFailure()) FAIL() << bits << " bits, case " << k;
    }
  }
  std::printf("%ld contacts, %ld misses, %ld by a little, %ld unproved, %ld exact as floats\n",
              counts.hits, counts.misses, counts.misses_by_a_little, counts.unproved,
              counts.exact_in_float);
  EXPECT_LE(counts.unproved, counts.misses / 500) << "misses without a proof";
  EXPECT_LE(counts.undecided, counts.exact_in_float / 2000);
  EXPECT_GT(counts.hits, 5000);
  EXPECT_GT(counts.misses, 5000);
  EXPECT_GT(counts.exact_in_float, 5000);
}

TEST(CcdCollapse, SmallIntegersAgreeWithTheProof) {
  // Few values give every kind of coincidence.
  Generator generator(1, 1);
  Counts counts;
  for (int k = 0; k < 12000; ++k) {
    Case c{k % 2 == 0 ? PairKind::vf : PairKind::ee, {}, 0, false, 1};
    const Integer most = 1 + k % 3;
    const auto number = [&] { return static_cast<double>(generator.pick(2 * most + 1) - most); };
    for (int i = 0; i < 4; ++i) {
      c.query.p0[i] = {number(), number(), number()};
      c.query.p1[i] = {number(), number(), number()};
    }
    check(c, counts);
    if (HasFatalFailure()) FAIL() << "case " << k;
  }
  EXPECT_EQ(counts.unproved, 0) << "misses without a proof";
  EXPECT_EQ(counts.undecided, 0);
  EXPECT_GT(counts.hits, 1000);
  EXPECT_GT(counts.misses, 5000);
}

}  // namespace
}  // namespace icloth
