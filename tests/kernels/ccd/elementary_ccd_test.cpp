// Hand-made cases of the elementary CCD, each tried at several scales and places, and random ones
// against constructions with a known contact and against a slow oracle.
#include "kernels/ccd/elementary_ccd.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "tests/oracle/slow_ccd.h"

namespace icloth {
namespace {

using Query = CcdQuery<double>;

template <class T>
bool ccd(PairKind kind, const CcdQuery<T>& q, CcdHit& hit, double separation = 0) {
  return kind == PairKind::vf ? ccd_vf(q, separation, hit) : ccd_ee(q, separation, hit);
}
template <class T>
bool filter(PairKind kind, const CcdQuery<T>& q) {
  return kind == PairKind::vf ? ccd_filter<PairKind::vf>(q) : ccd_filter<PairKind::ee>(q);
}

CcdQuery<float> to_float(const Query& q) {
  CcdQuery<float> out;
  for (int k = 0; k < 4; ++k) {
    out.p0[k] = convert<float>(q.p0[k]);
    out.p1[k] = convert<float>(q.p1[k]);
  }
  return out;
}

bool exact_in_float(const Query& q) {
  const CcdQuery<float> single = to_float(q);
  bool exact = true;
  for (int k = 0; k < 4; ++k) {
    exact = exact && convert<double>(single.p0[k]) == q.p0[k];
    exact = exact && convert<double>(single.p1[k]) == q.p1[k];
  }
  return exact;
}

Query moved(Query q, double scale, Vec3d shift) {
  for (int k = 0; k < 4; ++k) {
    q.p0[k] = scale * q.p0[k] + shift;
    q.p1[k] = scale * q.p1[k] + shift;
  }
  return q;
}

Vec3d gap_at(const Query& q, const CcdHit& hit, double t) {
  Vec3d gap;
  for (int k = 0; k < 4; ++k) gap += hit.w[k] * ((1 - t) * q.p0[k] + t * q.p1[k]);
  return gap;
}

void expect_sound(PairKind kind, const Query& q, const CcdHit& hit) {
  EXPECT_TRUE(hit.toi >= 0 && hit.toi <= 1);
  EXPECT_NEAR(norm(hit.normal), 1, 1e-12);
  EXPECT_NEAR(hit.w[0] + hit.w[1] + hit.w[2] + hit.w[3], 0, 1e-14);
  if (kind == PairKind::vf) {
    EXPECT_EQ(hit.w[0], 1);
    for (int k = 1; k < 4; ++k) EXPECT_TRUE(hit.w[k] <= 0 && hit.w[k] >= -1);
  } else {
    for (int k = 0; k < 4; ++k) EXPECT_TRUE(k < 2 ? hit.w[k] <= 0 : hit.w[k] >= 0);
    EXPECT_NEAR(hit.w[2] + hit.w[3], 1, 1e-14);
  }
  EXPECT_TRUE(filter(kind, q));
}

/// A contact at `time`, also after scaling.
CcdHit expect_hit(PairKind kind, const Query& q, double time, double late = 0) {
  CcdHit hit;
  EXPECT_TRUE(ccd(kind, q, hit));
  EXPECT_LE(hit.toi, time + late);
  EXPECT_GE(hit.toi, time - 1e-7);
  expect_sound(kind, q, hit);
  for (double scale : {0x1p-10, 0x1p-3, 0x1p10}) {
    const Query scaled = moved(q, scale, {});
    CcdHit other;
    EXPECT_TRUE(ccd(kind, scaled, other)) << "scale " << scale;
    EXPECT_LE(other.toi, time + late) << "scale " << scale;
    EXPECT_NEAR(norm(other.normal - hit.normal), 0, 1e-6) << "scale " << scale;
    EXPECT_TRUE(!exact_in_float(scaled) || ccd(kind, to_float(scaled), other));
  }
  return hit;
}

void expect_miss(PairKind kind, const Query& q) {
  CcdHit hit;
  EXPECT_FALSE(ccd(kind, q, hit)) << "toi " << hit.toi;
  for (double scale : {0x1p-10, 0x1p10}) {
    EXPECT_FALSE(ccd(kind, moved(q, scale, {}), hit)) << "scale " << scale;
  }
}

const Vec3d kA{0, 0, 0}, kB{1, 0, 0}, kC{0, 0, 1};

Query falling_vertex(Vec3d from, Vec3d to) { return {{from, kA, kB, kC}, {to, kA, kB, kC}}; }

TEST(ElementaryCcd, VertexFallsThroughFace) {
  const CcdHit above =
      expect_hit(PairKind::vf, falling_vertex({0.25, 1, 0.25}, {0.25, -1, 0.25}), 0.5);
  EXPECT_NEAR(above.toi, 0.5, 1e-12);
  EXPECT_NEAR(norm(above.normal - Vec3d{0, 1, 0}), 0, 1e-12);
  EXPECT_NEAR(above.w[1], -0.5, 1e-9);
  const CcdHit below =
      expect_hit(PairKind::vf, falling_vertex({0.25, -1, 0.25}, {0.25, 3, 0.25}), 0.25);
  EXPECT_NEAR(norm(below.normal - Vec3d{0, -1, 0}), 0, 1e-12);
  expect_miss(PairKind::vf, falling_vertex({0.75, 1, 0.75}, {0.75, -1, 0.75}));
  expect_miss(PairKind::vf, falling_vertex({0.25, 1, 0.25}, {0.25, 0.01, 0.25}));
}

TEST(ElementaryCcd, BordersAndBothEndsOfTheStepCount) {
  // On an edge, on a vertex, and an ulp beside them.
  expect_hit(PairKind::vf, falling_vertex({0.5, 1, 0.5}, {0.5, -1, 0.5}), 0.5);
  expect_hit(PairKind::vf, falling_vertex({0, 1, 0}, {0, -1, 0}), 0.5);
  const double out = -std::numeric_limits<double>::denorm_min();
  CcdHit hit;
  EXPECT_FALSE(ccd_vf(falling_vertex({0.25, 1, out}, {0.25, -1, out}), 0, hit));
  const double beyond = std::nextafter(0.5, 1);
  EXPECT_FALSE(ccd_vf(falling_vertex({0.5, 1, beyond}, {0.5, -1, beyond}), 0, hit));
  // At t = 1 exactly, and just not; touching at t = 0 and leaving.
  expect_hit(PairKind::vf, falling_vertex({0.25, 1, 0.25}, {0.25, 0, 0.25}), 1);
  EXPECT_FALSE(ccd_vf(falling_vertex({0.25, 1, 0.25}, {0.25, -out, 0.25}), 0, hit));
  EXPECT_EQ(expect_hit(PairKind::vf, falling_vertex({0.25, 0, 0.25}, {0.25, 1, 0.25}), 0).toi, 0);
  EXPECT_EQ(expect_hit(PairKind::vf, falling_vertex({0.25, 0, 0.25}, {0.25, 0, 0.25}), 0).toi, 0);
}

/// The face turns while the vertex passes so that the volume is (t − ½)² + gap.
Query grazing(double gap) {
  Query q;
  q.p0[0] = {0.25, 1, 0.25 + gap};
  q.p1[0] = {0.25, 0, 0.25 + gap};
  q.p0[1] = q.p1[1] = {0, 0, 0};
  q.p0[2] = q.p1[2] = {1, 0, 0};
  q.p0[3] = {0, 1, 0};
  q.p1[3] = {0, 1, 1};
  return q;
}

TEST(ElementaryCcd, AGrazingContactIsFoundAndAGapIsNot) {
  const CcdHit hit = expect_hit(PairKind::vf, grazing(0), 0.5);
  EXPECT_GT(hit.normal.z, 0);
  expect_miss(PairKind::vf, grazing(1e-6));
  expect_miss(PairKind::vf, grazing(0x1p-50));  // a gap of 1e-15
  CcdHit two;
  ASSERT_TRUE(ccd_vf(grazing(-0x1p-20), 0, two));
  EXPECT_NEAR(two.toi, 0.5 - 0x1p-10, 1e-9);
}

TEST(ElementaryCcd, CrossingEdgesMeetAtTheirTime) {
  const Query q{{{-1, 0, 0}, {1, 0, 0}, {0, 1, -1}, {0, 1, 3}},
                {{-1, 0, 0}, {1, 0, 0}, {0, -3, -1}, {0, -3, 3}}};
  const CcdHit hit = expect_hit(PairKind::ee, q, 0.25);
  EXPECT_NEAR(hit.w[0], -0.5, 1e-9);
  EXPECT_NEAR(hit.w[3], 0.25, 1e-9);
  EXPECT_NEAR(norm(hit.normal - Vec3d{0, 1, 0}), 0, 1e-12);
}

TEST(ElementaryCcd, ParallelAndCollinearEdgesAreDecided) {
  // Parallel edges fall on one another, side by side or overlapping.
  const auto parallel = [](double x, double gap) {
    return Query{{{0, 0, 0}, {1, 0, 0}, {x, 1, gap}, {x + 1, 1, gap}},
                 {{0, 0, 0}, {1, 0, 0}, {x, -1, gap}, {x + 1, -1, gap}}};
  };
  const CcdHit hit = expect_hit(PairKind::ee, parallel(0.5, 0), 0.5);
  EXPECT_NEAR(norm(hit.normal - Vec3d{0, 1, 0}), 0, 1e-9);
  expect_hit(PairKind::ee, parallel(1, 0), 0.5);  // end on end
  expect_miss(PairKind::ee, parallel(1.0000001, 0));
  expect_miss(PairKind::ee, parallel(0.5, 1e-15));
  // Sliding along the common line.
  const auto sliding = [](double offset) {
    return Query{{{0, 0, 0}, {1, 0, 0}, {2, offset, 0}, {3, offset, 0}},
                 {{0, 0, 0}, {1, 0, 0}, {0, offset, 0}, {1, offset, 0}}};
  };
  const CcdHit ends = expect_hit(PairKind::ee, sliding(0), 0.5);
  EXPECT_NEAR(norm(ends.normal - Vec3d{1, 0, 0}), 0, 1e-9);
  expect_miss(PairKind::ee, sliding(1e-9));
  CcdHit thick;
  EXPECT_TRUE(ccd_ee(sliding(1e-6), 1e-5, thick)) << "closer than the separation";
  EXPECT_FALSE(ccd_ee(sliding(1e-4), 1e-5, thick));
}

TEST(ElementaryCcd, MotionInOnePlaneIsDecided) {
  // The vertex moves in the plane of the face, in from the side or past a corner.
  const CcdHit in = expect_hit(PairKind::vf, falling_vertex({0.25, 0, -1}, {0.25, 0, 1}), 0.5);
  EXPECT_NEAR(norm(in.normal - Vec3d{0, 0, -1}), 0, 1e-9);
  expect_hit(PairKind::vf, falling_vertex({-1, 0, 2}, {1, 0, 0}), 0.5);  // meets the corner
  expect_miss(PairKind::vf, falling_vertex({-1, 0, 2.001}, {1, 0, 0.001 + 2e-16}));
  expect_miss(PairKind::vf, falling_vertex({2, 0, -5}, {2, 0, 5}));
  // A sheet that turns and slides in its own plane.
  const Query rigid{{{3, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}},
                    {{3.5, 0, 4}, {0.5, 0, 4}, {1.5, 0, 4}, {0.5, 0, 5}}};
  expect_miss(PairKind::vf, rigid);
  // An edge swings into another one in the plane.
  const Query swing{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0.5, 0, 2}},
                    {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-0.5, 0, 0.75}}};
  CcdHit hit;
  ASSERT_TRUE(ccd_ee(swing, 0, hit));
  EXPECT_NEAR(static_cast<double>(oracle::distance_at(PairKind::ee, swing, hit.toi)), 0, 1e-12);
  EXPECT_LE(hit.toi, 2.0 / 3);
}

TEST(ElementaryCcd, NeedlesSegmentsAndPointsAreDecided) {
  // A needle of width 1e-10, a face that is a segment, and one that is a point.
  const Query needle{{{0.5, 1, 5e-11}, {0, 0, 0}, {1, 0, 0}, {1, 0, 1e-10}},
                     {{0.5, -1, 2e-11}, {0, 0, 0}, {1, 0, 0}, {1, 0, 1e-10}}};
  CcdHit hit;
  EXPECT_TRUE(ccd_vf(needle, 0, hit));
  const Query segment{{{0.5, 1, 0}, kA, kB, kB}, {{0.5, -1, 0}, kA, kB, kB}};
  expect_hit(PairKind::vf, segment, 0.5);
  const Query point{{{1, 1, 0}, kB, kB, kB}, {{1, -1, 0}, kB, kB, kB}};
  expect_hit(PairKind::vf, point, 0.5);
  expect_miss(PairKind::vf, Query{{{0.5, 1, 1e-9}, kA, kB, kB}, {{0.5, -1, 1e-9}, kA, kB, kB}});
  const Query points{{kA, kA, {1, 1, 1}, {1, 1, 1}}, {kA, kA, {-1, -1, -1}, {-1, -1, -1}}};
  expect_hit(PairKind::ee, points, 0.5);
}

TEST(ElementaryCcd, NumbersThatAreNotFinite) {
  for (double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e200}) {
    for (int k = 0; k < 4; ++k) {
      Query q = falling_vertex({0.25, 10, 0.25}, {0.25, 9, 0.25});
      q.p1[k].y = bad;
      CcdHit hit;
      EXPECT_TRUE(ccd_vf(q, 0, hit));
      EXPECT_TRUE(ccd_ee(q, 0, hit));
      EXPECT_EQ(hit.toi, 0);
      EXPECT_NEAR(norm(hit.normal), 1, 1e-12);
      EXPECT_TRUE(ccd_vf(to_float(q), 0, hit));
      EXPECT_TRUE(filter(PairKind::vf, q) && filter(PairKind::ee, to_float(q)));
    }
  }
}

// ---- random queries -----------------------------------------------------------------------------

/// Multiples of 1/8 up to `cells`/8, so that sums and weighted means below are exact.
Vec3d grid_point(std::mt19937& generator, int cells) {
  std::uniform_int_distribution<int> u(-cells, cells);
  return {u(generator) / 8.0, u(generator) / 8.0, u(generator) / 8.0};
}

/// Two points in touch at `time` (½ or ¼) by construction, all numbers exact also as floats. Small
/// grids give many flat, parallel and coinciding configurations.
Query touching(PairKind kind, std::mt19937& generator, int cells, double time) {
  Vec3d x[4];
  for (Vec3d& p : x) p = grid_point(generator, cells);
  const double weights[] = {0, 0, 0.25, 0.5, 1};
  const double s = weights[generator() % 5], t = (1 - s) * weights[generator() % 5];
  if (kind == PairKind::vf) {
    x[0] = (1 - s - t) * x[1] + s * x[2] + t * x[3];
  } else {  // move the second edge so that its point meets the point of the first
    const double r = weights[generator() % 5];
    const Vec3d shift = ((1 - s) * x[0] + s * x[1]) - ((1 - r) * x[2] + r * x[3]);
    x[2] += shift;
    x[3] += shift;
  }
  Query q;
  const bool flat = generator() % 4 == 0, rigid = generator() % 8 == 0;
  const Vec3d common = grid_point(generator, cells);
  for (int k = 0; k < 4; ++k) {
    Vec3d motion = rigid && k > 0 ? common : grid_point(generator, cells);
    if (flat) motion.y = 0;
    q.p0[k] = x[k] - time * motion;
    q.p1[k] = x[k] + (1 - time) * motion;
    if (flat) q.p0[k].y = q.p1[k].y = 0;
  }
  return q;
}

void expect_contact(PairKind kind, const Query& q, double time) {
  CcdHit hit;
  ASSERT_TRUE(ccd(kind, q, hit));
  ASSERT_LE(hit.toi, time);
  expect_sound(kind, q, hit);
  if (!exact_in_float(q)) return;
  CcdHit single;
  ASSERT_TRUE(ccd(kind, to_float(q), single));
  ASSERT_LE(single.toi, time);
  ASSERT_TRUE(filter(kind, to_float(q)));
}

TEST(ElementaryCcd, NeverMissesAConstructedContact) {
  std::mt19937 generator(7);
  // Small grids for coincidences; the finest fills the 53 bits, so that every product rounds.
  const int grids[] = {1, 3, 64, 1 << 12, 1 << 24};
  for (int k = 0; k < 40000; ++k) {
    const PairKind kind = k % 2 == 0 ? PairKind::vf : PairKind::ee;
    const double time = k % 3 == 0 ? 0.25 : 0.5;
    const Query q = touching(kind, generator, grids[k % 5], time);
    expect_contact(kind, q, time);
    if (HasFatalFailure() || HasFailure()) FAIL() << "query " << k;
  }
}

TEST(ElementaryCcd, FollowsTheSlowOracle) {
  std::mt19937 generator(11);
  std::normal_distribution<double> gauss;
  int hits = 0;
  for (int k = 0; k < 20000; ++k) {
    const PairKind kind = k % 2 == 0 ? PairKind::vf : PairKind::ee;
    const double scale = std::pow(10.0, static_cast<double>(k % 7) - 3);
    Query q;
    for (int i = 0; i < 4; ++i) {
      q.p0[i] = Vec3d{gauss(generator), gauss(generator), gauss(generator)};
      q.p1[i] = q.p0[i] + Vec3d{gauss(generator), gauss(generator), gauss(generator)};
    }
    if (k % 10 == 0) {  // flat, after a turn that is not exact in binary
      for (Vec3d* x : {q.p0, q.p1}) {
        for (int i = 0; i < 4; ++i) x[i].z = 0.3 * x[i].x - 0.7 * x[i].y;
      }
    }
    q = moved(q, scale, k % 3 == 0 ? Vec3d{10, -10, 10} : Vec3d{});
    CcdHit hit;
    const bool is_hit = ccd(kind, q, hit);
    const auto near = static_cast<double>(oracle::first_approach(kind, q, 1e-9L * scale));
    if (near > 1) {
      EXPECT_FALSE(is_hit) << "query " << k << ": never closer than 1e-9 of its size";
    } else if (is_hit) {
      ++hits;
      EXPECT_GE(hit.toi, near - 1e-7) << "query " << k;
      EXPECT_LT(static_cast<double>(oracle::distance_at(kind, q, hit.toi)), 1e-9 * scale + 1e-13);
      const double before = hit.toi * (1 - 1e-5);
      // The side it comes from. Flat ones may overlap from the start, and are flat only up to
      // rounding, which may decide about the normal.
      const Vec3d gap = gap_at(q, hit, before);
      const bool flat = k % 10 == 0;
      if (!flat) {
        EXPECT_GT(dot(hit.normal, gap), 0) << "query " << k;
      } else if (hit.toi > 1e-3) {
        EXPECT_GT(dot(hit.normal, gap), -1e-9 * norm(gap) - 1e-14) << "query " << k;
      }
    } else {
      // So near and no contact: it must really be a near miss, not a passage.
      EXPECT_GT(static_cast<double>(oracle::distance_at(kind, q, near)), 0) << "query " << k;
    }
  }
  EXPECT_GT(hits, 500);
}

TEST(ElementaryCcd, FilterKeepsWhatTheFullTestFinds) {
  std::mt19937 generator(13);
  std::normal_distribution<float> gauss;
  int kept = 0, hits = 0;
  for (int k = 0; k < 50000; ++k) {
    const PairKind kind = k % 2 == 0 ? PairKind::vf : PairKind::ee;
    CcdQuery<float> q;
    Query exact;
    for (int i = 0; i < 4; ++i) {
      q.p0[i] = {gauss(generator), gauss(generator), gauss(generator)};
      q.p1[i] = q.p0[i] + Vec3f{gauss(generator), gauss(generator), gauss(generator)};
      exact.p0[i] = convert<double>(q.p0[i]);
      exact.p1[i] = convert<double>(q.p1[i]);
    }
    CcdHit a, b;
    const bool single = ccd(kind, q, a), full = ccd(kind, exact, b);
    EXPECT_EQ(single, full) << "query " << k;
    EXPECT_TRUE(filter(kind, q) || !full) << "query " << k;
    kept += filter(kind, q);
    hits += full;
  }
  EXPECT_GT(hits, 1000);
  EXPECT_LT(kept, 25000) << "the filter has to cull";
}

}  // namespace
}  // namespace icloth
