// The multilevel preconditioner: its groups, its algebra, and what it does to the iterations.
#define ICLOTH_BUILD cpu32
#define ICLOTH_REAL float

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "sim/linear/aggregation.h"
#include "sim/simulator.h"
#include "tests/sim/linear/linear_system_support.h"

namespace icloth::cpu32 {
namespace {

/// Stands in for cloth: `sheets` separate grids of side × side vertices of mass 1, springs of a
/// given stiffness along edges and diagonals, pinned corners, contacts between the sheets.
struct Sheets : TestSystem {
  Index side, count;
  std::mt19937 random{7};

  explicit Sheets(Index side_, Index sheets, Real stiffness, Real contact_stiffness = 0,
                  Real obstacle_weight = Real(-0.25))
      : side(side_), count(sheets * side_ * side_) {
    inverse_mass.assign(at(count), Real(1));
    for (Index i = 0; i < count; ++i) blocks[{i, i}] = Mat3r::identity(1);
    for (Index s = 0; s < sheets; ++s) add_sheet(s * side * side, stiffness);
    if (contact_stiffness > 0)
      for (Index i = 0; i + side * side < count; i += 3)
        add_contact(i, contact_stiffness, obstacle_weight);
    upload();
  }

  Vec3r vector() {
    std::uniform_real_distribution<Real> uniform(-1, 1);
    const Real a = uniform(random), c = uniform(random), d = uniform(random);
    return {a, c, d};
  }

  void add_sheet(Index first, Real stiffness) {
    const auto vertex = [&](Index i, Index j) { return first + j * side + i; };
    for (Index j = 0; j < side; ++j)
      for (Index i = 0; i < side; ++i) {
        if (i + 1 < side) add_spring(vertex(i, j), vertex(i + 1, j), {1, 0, 0}, stiffness);
        if (j + 1 < side) add_spring(vertex(i, j), vertex(i, j + 1), {0, 1, 0}, stiffness);
        if (i + 1 < side && j + 1 < side)
          add_spring(vertex(i, j), vertex(i + 1, j + 1), {Real(0.7), Real(0.7), 0}, stiffness);
      }
    if (side > 1) inverse_mass[at(vertex(0, 0))] = inverse_mass[at(vertex(side - 1, 0))] = 0;
  }

  void add_spring(Index i, Index j, Vec3r along, Real stiffness) {
    const Mat3r k =
        stiffness * (outer(along, along) + Mat3r::identity(Real(0.05)));  // soft out of the plane
    blocks[{i, i}] += k;
    blocks[{j, j}] += k;
    blocks[{i, j}] += Real(-1) * k;
  }

  void add_contact(Index i, Real stiffness, Real obstacle_weight) {
    Coupling c{};
    const Index other = i + side * side;
    const Index corners[4] = {i, other, other == count - 1 ? other - 1 : other + 1,
                              count + i % 5};  // the last one is an obstacle's
    const Real weights[4] = {1, Real(-0.5), Real(-0.5) - obstacle_weight, obstacle_weight};
    for (int a = 0; a < 4; ++a) c.s.v[a] = corners[a], c.s.w[a] = weights[a];
    const Real along = Real(0.1) * stiffness;
    c.h = {{along, 0, 0, along, 0, stiffness}};
    coupling_list.push_back(c);
  }

  void upload() {
    upload_matrix(count);
    inverse_mass.resize(at(count) + 5, 0);
    for (const Coupling& c : coupling_list)
      for (int a = 0; a < 4; ++a) {
        const Index v = c.s.v[a];
        if (v < count) blocks[{v, v}] += c.h.scaled(c.s.w[a] * c.s.w[a]);
      }
    std::vector<Vec3r> rhs;
    for (Index i = 0; i < count; ++i)
      rhs.push_back(inverse_mass[at(i)] > 0 ? Vec3r{0, -1, 0} + Real(0.2) * vector() : Vec3r{});
    upload_rest(count, rhs);
  }

  LinearSolution solve(Preconditioner preconditioner, double tolerance = 1e-3) {
    x.fill(Vec3r{});
    return solve_from_x({preconditioner, tolerance, 2000});
  }
};

struct ApplyOnce {
  Multilevel precondition;
  View<const Vec3r> from;
  View<Vec3r> r, z;
  template <class Team>
  void operator()(Team& team) const {
    precondition(
        team, [&](Index i) { return r[i] = from[i]; }, r, z);
  }
};

/// M⁻¹ v with the levels as they are filled.
std::vector<Vec3r> applied(Hierarchy& hierarchy, Sheets& sheets, const std::vector<Vec3r>& v) {
  Array<Vec3r> from, r(sheets.count), z(sheets.count);
  from.upload(v);
  with_device_team("test", sheets.count,
                   ApplyOnce{hierarchy.view(sheets.system(), sheets.inverse_diagonal.view()),
                             from.view(), r.view(), z.view()});
  return z.download();
}

/// M⁻¹ v.
std::vector<Vec3r> preconditioned(Sheets& sheets, const std::vector<Vec3r>& v) {
  Hierarchy hierarchy;
  hierarchy.set_up(sheets.row_first, sheets.column);
  hierarchy.fill_matrix(sheets.system());
  hierarchy.fill_contacts(sheets.system());
  return applied(hierarchy, sheets, v);
}

std::vector<Vec3r> random_vector(Sheets& sheets) {
  std::vector<Vec3r> v;
  for (Index i = 0; i < sheets.count; ++i)
    v.push_back(sheets.inverse_mass[at(i)] > 0 ? sheets.vector() : Vec3r{});
  return v;
}

double inner(const std::vector<Vec3r>& a, const std::vector<Vec3r>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += dot_double(a[i], b[i]);
  return sum;
}

TEST(Multilevel, IsSymmetricAndPositiveDefinite) {
  for (const Real stiffness : {Real(1), Real(100), Real(1e4)}) {
    Sheets sheets(24, 3, stiffness, 50);
    for (int trial = 0; trial < 5; ++trial) {
      const auto u = random_vector(sheets), v = random_vector(sheets);
      const auto mu = preconditioned(sheets, u), mv = preconditioned(sheets, v);
      const double uu = inner(u, mu), vv = inner(v, mv);
      EXPECT_GT(uu, 0);
      EXPECT_GT(vv, 0);
      EXPECT_NEAR(inner(u, mv), inner(v, mu), 1e-5 * std::sqrt(uu * vv)) << stiffness;
    }
  }
}

TEST(Multilevel, FillingSomeRowsAnewGivesTheLevelsOfAllRows) {
  Sheets sheets(40, 3, 100, 50);
  const auto v = random_vector(sheets);
  Hierarchy hierarchy;
  hierarchy.set_up(sheets.row_first, sheets.column);
  hierarchy.fill_matrix(sheets.system());
  hierarchy.fill_contacts(sheets.system());
  const auto before = applied(hierarchy, sheets, v);

  // A few rows become stiffer, each with the block to the next vertex.
  std::vector<Mat3r> value = sheets.matrix.value.download();
  std::vector<std::uint8_t> renewed(at(sheets.count), 0);
  for (const Index i : {100, 101, 777, 2500}) {
    renewed[at(i)] = 1;
    const Mat3r more = Mat3r::identity(static_cast<Real>(i));
    value[at(sheets.row_first[at(i)])] += more;
    value[at(sheets.row_first[at(i)] + 1)] += Real(-0.1) * more;
  }
  sheets.matrix.value.upload_range(0, value);
  Array<std::uint8_t> flags;
  flags.upload(renewed);

  // Twice, as contacts that were added before must not be counted again.
  for (int k = 0; k < 2; ++k) {
    hierarchy.fill_matrix(sheets.system(), flags.view());
    hierarchy.fill_contacts(sheets.system());
    const auto some = applied(hierarchy, sheets, v), all = preconditioned(sheets, v);
    EXPECT_TRUE(std::equal(some.begin(), some.end(), all.begin(), all.end()));
    EXPECT_FALSE(std::equal(some.begin(), some.end(), before.begin(), before.end()));
  }
}

TEST(Multilevel, LeavesPrescribedVerticesAlone) {
  Sheets sheets(20, 2, 100, 50);
  const auto z = preconditioned(sheets, random_vector(sheets));
  sheets.solve(Preconditioner::multilevel);
  const auto x = sheets.x.download();
  int prescribed = 0;
  for (Index i = 0; i < sheets.count; ++i) {
    if (sheets.inverse_mass[at(i)] > 0) continue;
    ++prescribed;
    EXPECT_TRUE(z[at(i)] == Vec3r{});
    EXPECT_TRUE(x[at(i)] == Vec3r{});
  }
  EXPECT_EQ(prescribed, 4);
}

TEST(Multilevel, NeedsSeveralTimesFewerIterations) {
  Sheets stiff(60, 1, 2000);
  const LinearSolution one = stiff.solve(Preconditioner::block_jacobi);
  const LinearSolution many = stiff.solve(Preconditioner::multilevel);
  EXPECT_LT(one.residual, 1.5e-3);  // single precision cannot do much better
  EXPECT_LT(many.residual, 1.5e-3);
  EXPECT_LT(3 * many.iterations, one.iterations) << many.iterations << " of " << one.iterations;
  Sheets touching(40, 3, 2000, 100);
  const Index plain = touching.solve(Preconditioner::block_jacobi).iterations;
  EXPECT_LT(2 * touching.solve(Preconditioner::multilevel).iterations, plain) << plain;
}

/// Sheets that lie on each other and on nothing else move together as easily as one does.
TEST(Multilevel, LayersInContactAreNotHeldInPlace) {
  Sheets apart(40, 2, 2000), touching(40, 2, 2000, 2000, 0);
  const Index free = apart.solve(Preconditioner::multilevel).iterations;
  const LinearSolution held = touching.solve(Preconditioner::multilevel);
  EXPECT_LT(held.residual, 1.5e-3);
  EXPECT_LT(2 * held.iterations, 3 * free) << held.iterations << " against " << free;
}

TEST(Multilevel, BothPreconditionersFindTheSameSolution) {
  Sheets sheets(30, 2, 20, 20);
  EXPECT_LT(sheets.solve(Preconditioner::block_jacobi, 1e-5).residual, 3e-5);
  const auto expected = sheets.x.download();
  EXPECT_LT(sheets.solve(Preconditioner::multilevel, 1e-5).residual, 3e-5);
  const auto found = sheets.x.download();
  double error = 0;
  for (Index i = 0; i < sheets.count; ++i)
    error = std::max(error, static_cast<double>(norm(found[at(i)] - expected[at(i)])));
  EXPECT_LT(error, 1e-3 * std::sqrt(inner(expected, expected)));
}

TEST(Multilevel, GivesTheSameBitsWithAnyNumberOfThreads) {
  Sheets sheets(70, 3, 500, 50);
  std::vector<Vec3r> results[2];
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    sheets.solve(Preconditioner::multilevel);
    sheets.x.resize(sheets.count);
    sheets.x.download(results[threads - 1]);
  }
  set_thread_count(0);
  EXPECT_GT(inner(results[0], results[0]), 0);
  EXPECT_TRUE(results[0] == results[1]);
}

/// Beyond what single precision resolves (masses below the rounding of the stiffness) a solve must
/// not run away.
TEST(Multilevel, NeverEndsWorseThanItStarted) {
  for (const Preconditioner preconditioner :
       {Preconditioner::block_jacobi, Preconditioner::multilevel}) {
    for (const Real stiffness : {Real(1e6), Real(1e8), Real(1e10)}) {
      Sheets sheets(12, 1, stiffness);
      const LinearSolution solution = sheets.solve(preconditioner, 1e-5);
      EXPECT_LE(solution.residual, 1.0) << stiffness;
      for (const Vec3r& v : sheets.x.download()) EXPECT_TRUE(norm(v) < 1e6) << stiffness;
    }
  }
}

TEST(Multilevel, SolvesWhatHasNoLevels) {
  Sheets nothing(0, 1, 1), vertex(1, 1, 1), pieces(1, 300, 1), pairs(2, 200, 100);
  EXPECT_EQ(nothing.solve(Preconditioner::multilevel).iterations, 0);
  EXPECT_EQ(vertex.solve(Preconditioner::multilevel).iterations, 1);
  EXPECT_LT(vertex.solve(Preconditioner::multilevel).residual, 1e-6);
  EXPECT_LE(pieces.solve(Preconditioner::multilevel).iterations, 2);
  EXPECT_LT(pairs.solve(Preconditioner::multilevel).residual, 1.1e-3);
}

/// Pattern and systems may change what is prescribed between two solves, up to everything.
TEST(Multilevel, AllPrescribedIsNoWork) {
  Sheets sheets(12, 1, 100);
  for (Real& m : sheets.inverse_mass) m = 0;
  sheets.masses.upload(sheets.inverse_mass);
  sheets.b.fill(Vec3r{});
  EXPECT_EQ(sheets.solve(Preconditioner::multilevel).iterations, 0);
}

/// Σ h_c (Σ w over the node's free vertices)(Σ w over the other's), for each pair of nodes.
TEST(CoarseCouplings, AreTheCouplingsSummedUpOverGroups) {
  Sheets sheets(14, 3, 100, 90);
  std::vector<Index> group;
  for (Index i = 0; i < sheets.count; ++i) group.push_back(i / 5);
  const Index nodes = group.back() + 1;
  std::map<std::pair<Index, Index>, Mat3r> expected;
  for (const Coupling& c : sheets.coupling_list)
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) {
        const Index i = c.s.v[a], j = c.s.v[b];
        if (i >= sheets.count || j >= sheets.count) continue;
        if (!(sheets.inverse_mass[at(i)] > 0) || !(sheets.inverse_mass[at(j)] > 0)) continue;
        expected[{group[at(i)], group[at(j)]}] += c.h.scaled(c.s.w[a] * c.s.w[b]);
      }
  Array<Index> groups;
  groups.upload(group);
  CoarseCouplings coupled;
  coupled.fill(sheets.system(), groups.view(), nodes);
  const CoarseRows rows = coupled.rows();
  ASSERT_EQ(rows.first.size(), nodes + 1);
  ASSERT_EQ(rows.column.size(), static_cast<Index>(expected.size()));
  auto pair = expected.begin();
  for (Index i = 0; i < nodes; ++i)
    rows.of_row(i, [&](Index j, const Mat3r& block) {
      EXPECT_EQ(pair->first, std::pair(i, j));
      for (int e = 0; e < 9; ++e) EXPECT_NEAR(block.m[e], pair->second.m[e], 1e-3) << i << ' ' << j;
      ++pair;
    });
  EXPECT_TRUE(pair == expected.end());
}

TEST(Couplings, AreTheActiveContactsWithTheirVertices) {
  constexpr Index kVertices = 6;  // of the cloth; the last corner is an obstacle's
  std::vector<Contact> contacts(5);
  std::vector<ContactTerm> terms(5);
  for (int c = 0; c < 5; ++c) {
    contacts[at(c)].s = {{c, (c + 1) % 6, (c + 2) % 6, 7}, {1, Real(-0.5), Real(-0.25), Real(c)}};
    terms[at(c)].active = c % 2;
    terms[at(c)].h.m[0] = static_cast<Real>(c);
    terms[at(c)].impulse = {static_cast<Real>(c), 0, 0};
  }
  Array<Contact> contact_array;
  Array<ContactTerm> term_array;
  contact_array.upload(contacts);
  term_array.upload(terms);
  Couplings couplings;
  couplings.gather(contact_array.view(), term_array.view(), kVertices);
  const CouplingView view = couplings.view();
  ASSERT_EQ(view.size(), 2);
  EXPECT_EQ(view.list[0].h.m[0], 1);
  EXPECT_EQ(view.list[1].impulse.x, 3);
  const std::vector<std::vector<std::pair<Index, Real>>> expected{{},
                                                                  {{0, 1}},
                                                                  {{0, Real(-0.5)}},
                                                                  {{0, Real(-0.25)}, {1, 1}},
                                                                  {{1, Real(-0.5)}},
                                                                  {{1, Real(-0.25)}}};
  for (Index i = 0; i < kVertices; ++i) {
    std::vector<std::pair<Index, Real>> seen;
    view.of_vertex(i, [&](Index c, Real w) { seen.emplace_back(c, w); });
    EXPECT_EQ(seen, expected[at(i)]) << i;
    EXPECT_EQ(view.touch(i), !seen.empty());
  }
  couplings.clear();
  couplings.gather({}, {}, kVertices);
  EXPECT_EQ(couplings.view().size(), 0);
  EXPECT_FALSE(couplings.view().touch(1));
}

TEST(Couplings, KeepTheirPlacesWhileContactsOpenAndCloseAgain) {
  constexpr Index kVertices = 6;
  std::vector<Contact> contacts(4);
  for (int c = 0; c < 4; ++c) contacts[at(c)].s = {{c, c + 1, c + 2, 7}, {1, -1, 0, 0}};
  Array<Contact> contact_array;
  contact_array.upload(contacts);
  Couplings couplings;
  const auto gather = [&](const std::vector<int>& active) {
    std::vector<ContactTerm> terms(4);
    for (const int c : active) {
      terms[at(c)].active = 1;
      terms[at(c)].h = {{1, 0, 0, 1, 0, static_cast<Real>(c)}};
    }
    Array<ContactTerm> array;
    array.upload(terms);
    couplings.gather(contact_array.view(), array.view(), kVertices);
    return couplings.view();
  };
  const auto corners = [](const CouplingView& view) {
    std::vector<Index> first;
    for (Index c = 0; c < view.size(); ++c) first.push_back(view.list[c].s.v[0]);
    return first;
  };

  // A contact that opens keeps its place, with nothing in it.
  const std::uint64_t layout = gather({1, 3}).layout;
  CouplingView view = gather({3});
  EXPECT_EQ(view.layout, layout);
  EXPECT_EQ(corners(view), (std::vector<Index>{1, 3}));
  EXPECT_FALSE(view.list[0].acts());
  EXPECT_TRUE(view.list[1].acts());
  EXPECT_FALSE(view.touch(1));
  EXPECT_TRUE(view.touch(3));

  // One that closes is put in its place, whatever was there before.
  view = gather({0, 1});
  EXPECT_NE(view.layout, layout);
  EXPECT_EQ(corners(view), (std::vector<Index>{0, 1, 3}));
  EXPECT_TRUE(view.list[1].acts());
  EXPECT_FALSE(view.list[2].acts());

  // Only clear() forgets.
  couplings.clear();
  EXPECT_EQ(corners(gather({2})), (std::vector<Index>{2}));
}

TEST(Couplings, AddedOnesLeaveTheListsAsIfAllHadBeenThereAtOnce) {
  constexpr Index kVertices = 300, kContacts = 2000, kNodes = 40;
  std::mt19937 random(21);
  const auto vertex = [&](Index end) {
    return static_cast<Index>(random() % static_cast<unsigned>(end));
  };
  std::vector<Contact> contacts(kContacts);
  std::vector<ContactTerm> terms(kContacts);
  for (Index c = 0; c < kContacts; ++c) {
    // The vertices of a contact differ; now and then the last one is an obstacle's.
    const Index first = vertex(kVertices - 10);
    contacts[at(c)].s = {{first, first + 1, first + 2 + vertex(3), first + 5 + vertex(5)},
                         {Real(0.25), Real(-0.5), Real(-0.125), Real(c % 7)}};
    if (c % 9 == 0) contacts[at(c)].s.v[3] = kVertices + 3;
    terms[at(c)].h = {{static_cast<Real>(1 + c % 5), 0, 0, 2, 0, 3}};
  }
  Array<Contact> contact_array;
  contact_array.upload(contacts);
  Array<Real> masses;
  masses.upload(std::vector<Real>(kVertices, Real(1)));
  std::vector<Index> group;
  for (Index i = 0; i < kVertices; ++i) group.push_back(i * kNodes / kVertices);
  Array<Index> groups;
  groups.upload(group);
  Array<Coupling> more;  // as of a seam
  more.upload({Coupling{{{0, 5, 9, 40}, {1, -1, Real(0.5), 0}}, {{1, 0, 0, 1, 0, 1}}, {}}});

  // A few contacts close in every pass, now and then none, and some open again.
  Couplings followed;
  CoarseCouplings coarse_followed;
  std::vector<Index> has_place;
  for (int pass = 0; pass < 12; ++pass) {
    for (Index c = 0; c < kContacts; ++c) {
      Index& active = terms[at(c)].active;
      if (pass != 5 && random() % 10 == 0) active = 1;
      if (active != 0 && random() % 20 == 0) active = 0;
    }
    if (pass == 8) followed.clear();
    Array<ContactTerm> term_array;
    term_array.upload(terms);
    followed.gather(contact_array.view(), term_array.view(), kVertices, more.view());
    const CouplingView view = followed.view();
    EXPECT_EQ(view.change.from != 0, pass != 0 && pass != 8) << pass;

    // The oracle takes all that have a place in one layout, and then empties the same ones.
    if (pass == 0 || pass == 8) has_place.assign(kContacts, 0);
    std::vector<ContactTerm> listed = terms;
    for (Index c = 0; c < kContacts; ++c) {
      has_place[at(c)] = has_place[at(c)] | terms[at(c)].active;
      listed[at(c)].active = has_place[at(c)];
    }
    Array<ContactTerm> listed_array;
    listed_array.upload(listed);
    Couplings fresh;
    fresh.gather(contact_array.view(), listed_array.view(), kVertices, more.view());
    fresh.gather(contact_array.view(), term_array.view(), kVertices, more.view());
    const CouplingView expected = fresh.view();
    ASSERT_EQ(view.size(), expected.size());
    for (Index i = 0; i < kVertices; ++i) {
      std::vector<std::pair<Index, Real>> a, b;
      view.of_vertex(i, [&](Index c, Real w) { a.emplace_back(c, w); });
      expected.of_vertex(i, [&](Index c, Real w) { b.emplace_back(c, w); });
      ASSERT_EQ(a, b) << "pass " << pass << " vertex " << i;
    }

    // The same holds for the blocks of the level below.
    SystemView system{};
    system.inverse_mass = masses.view();
    system.couplings = view;
    coarse_followed.fill(system, groups.view(), kNodes);
    CoarseCouplings coarse;
    system.couplings = expected;
    coarse.fill(system, groups.view(), kNodes);
    const CoarseRows a = coarse_followed.rows(), b = coarse.rows();
    ASSERT_EQ(a.column.size(), b.column.size());
    for (Index k = 0; k < a.column.size(); ++k) {
      ASSERT_EQ(a.column[k], b.column[k]);
      for (int e = 0; e < 9; ++e) ASSERT_EQ(a.value[k].m[e], b.value[k].m[e]);
    }
    for (Index i = 0; i <= kNodes; ++i) ASSERT_EQ(a.first[i], b.first[i]);
  }
}

TEST(CoarseCouplings, RenewTheirNumbersInTheirPlaces) {
  Sheets sheets(14, 3, 100, 90);
  std::vector<Index> group;
  for (Index i = 0; i < sheets.count; ++i) group.push_back(i / 5);
  const Index nodes = group.back() + 1;
  Array<Index> groups;
  groups.upload(group);
  const auto filled = [&](CoarseCouplings& coupled, Real scale) {
    std::vector<Coupling> list = sheets.coupling_list;
    for (Coupling& c : list)
      for (Real& h : c.h.m) h *= scale;
    Array<Coupling> couplings;
    couplings.upload(list);
    SystemView system = sheets.system();
    system.couplings.list = couplings.view();
    system.couplings.layout = 5;
    coupled.fill(system, groups.view(), nodes);
    std::vector<Real> numbers;
    for (Index i = 0; i < nodes; ++i)
      coupled.rows().of_row(i, [&](Index, const Mat3r& block) {
        numbers.insert(numbers.end(), std::begin(block.m), std::end(block.m));
      });
    return numbers;
  };
  CoarseCouplings renewed, fresh;
  filled(renewed, 1);
  EXPECT_EQ(filled(renewed, 3), filled(fresh, 3));
}

bool connected(const Graph& graph, const std::vector<Index>& members) {
  std::set<Index> left(members.begin(), members.end());
  std::vector<Index> queue{members.front()};
  left.erase(members.front());
  while (!queue.empty()) {
    const Index i = queue.back();
    queue.pop_back();
    for (Index k = graph.first[at(i)]; k < graph.first[at(i) + 1]; ++k)
      if (left.erase(graph.neighbour[at(k)]) > 0) queue.push_back(graph.neighbour[at(k)]);
  }
  return left.empty();
}

TEST(Aggregation, MakesGroupsOfAboutTheSize) {
  const Sheets sheets(50, 2, 1);
  const Graph graph = graph_of_pattern(sheets.row_first, sheets.column);
  ASSERT_EQ(graph.size(), sheets.count);
  const Aggregation groups = aggregate(graph, 8);
  std::vector<std::vector<Index>> members(at(groups.count));
  for (Index i = 0; i < graph.size(); ++i) members.at(at(groups.group[at(i)])).push_back(i);
  std::size_t whole = 0;
  for (const auto& group : members) {
    ASSERT_FALSE(group.empty());
    EXPECT_LE(group.size(), 12u);
    whole += connected(graph, group) ? 1 : 0;
    EXPECT_EQ(group.front() / 2500, group.back() / 2500);  // no group spans both sheets
  }
  EXPECT_GT(whole, members.size() * 9 / 10);  // what was given away may have been a bridge
  EXPECT_LT(members.size(), 5000u / 7);
}

TEST(Aggregation, CoarsePatternHasTheDiagonalAndEachPairOnce) {
  const Sheets sheets(10, 1, 1);
  const Graph graph = graph_of_pattern(sheets.row_first, sheets.column);
  const Aggregation groups = aggregate(graph, 4);
  std::vector<Index> first, column;
  coarse_pattern(graph, groups, first, column);
  ASSERT_EQ(first.size(), at(groups.count) + 1);
  std::set<std::pair<Index, Index>> expected, found;
  for (Index g = 0; g < groups.count; ++g) {
    EXPECT_EQ(column[at(first[at(g)])], g);
    expected.insert({g, g});
    for (Index k = first[at(g)]; k < first[at(g) + 1]; ++k)
      EXPECT_TRUE(found.insert({g, column[at(k)]}).second);
  }
  for (Index i = 0; i < graph.size(); ++i)
    for (Index k = graph.first[at(i)]; k < graph.first[at(i) + 1]; ++k) {
      const Index a = groups.group[at(i)], c = groups.group[at(graph.neighbour[at(k)])];
      expected.insert({std::min(a, c), std::max(a, c)});
    }
  EXPECT_EQ(found, expected);
}

}  // namespace
}  // namespace icloth::cpu32
