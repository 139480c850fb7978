// Rows that later linearisations leave as they are, against assembling all of them (double build).
#define ICLOTH_BUILD cpu64
#define ICLOTH_REAL double

#include "sim/mechanics/assembly.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "sim/mechanics/fabrics.h"
#include "tests/support/stage_support.h"

namespace icloth::cpu64 {
namespace {

/// A sheet at rest that is linearised twice: as it is, and with a few vertices moved. What has not
/// moved has the same terms whether it is renewed or not.
struct TwiceLinearised {
  Stage stage;
  Array<Vec3r> at, predicted, free_motion;
  Array<std::uint8_t> renewed;  ///< the faces at vertices that moved

  explicit TwiceLinearised(BendingModel bending) : stage(scene_of(bending)) {
    upload_fabrics(stage.mesh, stage.scene, stage.parameters);
    if (bending == BendingModel::plate) upload_plates(stage.mesh, stage.world);
    const auto vertices = static_cast<std::size_t>(stage.world.cloth_vertices);
    std::vector<Vec3r> shape = stage.start, motion(vertices, Vec3r{0, -1e-3, 0});
    free_motion.upload(motion);
    std::vector<bool> moved(vertices);
    for (std::size_t i = 0; i < vertices; ++i) {
      moved[i] = norm(shape[i] - shape[vertices / 2]) < 0.03;
      if (!moved[i]) continue;
      const Vec3r by{1e-3, 2e-3, static_cast<Real>(i % 3) * 1e-3};
      shape[i] += by;
      motion[i] = motion[i] - by;
    }
    at.upload(shape);
    predicted.upload(motion);

    std::vector<std::uint8_t> flags;
    for (Index f = 0; f < stage.world.cloth_faces; ++f) {
      const Triangle& corners = stage.world.face[static_cast<std::size_t>(f)];
      flags.push_back(std::ranges::any_of(
          corners, [&](Index v) { return moved[static_cast<std::size_t>(v)]; }));
    }
    renewed.upload(flags);
  }

  static Scene scene_of(BendingModel bending) {
    Scene scene;
    scene.cloths.push_back(testing::make_sheet(testing::lying(0.3, 600), {}));
    scene.parameters.material.bending = bending;
    return scene;
  }

  /// Linearises twice; the second time only what has to be renewed, or all of it.
  void assemble(Assembly& assembly, bool all) {
    assembly.match_pattern(stage.world, stage.mesh);
    SubstepContext step = stage.context();
    assembly.begin_substep(step);
    Linearization point{.start = stage.state.x0.view(),
                        .at = stage.state.x0.view(),
                        .predicted = free_motion.view(),
                        .v = stage.state.v.view(),
                        .dt = Real(0.01)};
    assembly.assemble(context(point));
    point.at = at.view();
    point.predicted = predicted.view();
    if (!all) point.renewed = renewed.view();
    assembly.assemble(context(point));
  }

  ForceContext context(const Linearization& point) const {
    return {.mesh = stage.mesh,
            .parameters = stage.parameters,
            .state = stage.state,
            .point = point,
            .free_motion = free_motion.view()};
  }
};

template <class T>
bool same_bits(const T* a, const T* b, Index count) {
  return std::memcmp(a, b, static_cast<std::size_t>(count) * sizeof(T)) == 0;
}

class AssemblyOf : public ::testing::TestWithParam<BendingModel> {};
INSTANTIATE_TEST_SUITE_P(Bending, AssemblyOf,
                         ::testing::Values(BendingModel::plate, BendingModel::hinge));

TEST_P(AssemblyOf, SomeRowsAnewGivesTheSystemOfAllRowsAnew) {
  TwiceLinearised sheet(GetParam());
  Assembly some, all;
  sheet.assemble(some, false);
  sheet.assemble(all, true);
  const Index blocks = some.matrix().column.size(), rows = some.rhs().size();
  ASSERT_EQ(all.matrix().column.size(), blocks);
  EXPECT_TRUE(same_bits(some.matrix().view().entries, all.matrix().view().entries, 9 * blocks));
  EXPECT_TRUE(same_bits(some.rhs().data(), all.rhs().data(), rows));
}

TEST_P(AssemblyOf, OnlyRowsNearRenewedFacesAreWritten) {
  TwiceLinearised sheet(GetParam());
  Assembly some;
  sheet.assemble(some, false);
  Index rows = 0, moved = 0;
  for (Index i = 0; i < some.renewed_rows().size(); ++i) rows += some.renewed_rows()[i];
  for (const std::uint8_t flag : sheet.renewed.download()) moved += flag;
  EXPECT_GT(moved, 10);

  // Single hinges are all linearised anew, and with them every row.
  const Index vertices = sheet.stage.world.cloth_vertices;
  if (GetParam() == BendingModel::hinge)
    EXPECT_EQ(rows, vertices);
  else
    EXPECT_LT(rows, vertices / 2);
  EXPECT_GT(rows, moved / 2);
}

}  // namespace
}  // namespace icloth::cpu64
