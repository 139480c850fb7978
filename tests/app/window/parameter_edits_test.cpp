// Edits of parameters can be undone, and reach the solver in order.
#include "app/window/parameter_edits.h"

#include <gtest/gtest.h>

#include <limits>

#include "sim/scene/presets.h"

namespace icloth {
namespace {

const ParameterInfo& row(const char* name) { return *find_parameter(name); }

TEST(ParameterEdits, AValueIsClampedRoundedAndMarked) {
  ParameterEdits edits{Parameters{}};
  const ParameterInfo& mu = row("impact_zones.penalty");
  const ParameterInfo& rounds = row("impact_zones.max_rounds");
  EXPECT_FALSE(edits.changed(mu));
  edits.set(mu, 1e30);
  EXPECT_DOUBLE_EQ(edits.value(mu), mu.maximum);
  EXPECT_TRUE(edits.changed(mu));
  edits.set(rounds, 12.4);
  EXPECT_EQ(edits.values().impact_zones.max_rounds, 12);
  edits.set(mu, std::numeric_limits<double>::quiet_NaN());
  EXPECT_DOUBLE_EQ(edits.value(mu), mu.maximum);
  edits.reset(mu);
  EXPECT_FALSE(edits.changed(mu));
}

TEST(ParameterEdits, OneGestureIsUndoneAtOnce) {
  ParameterEdits edits{Parameters{}};
  const ParameterInfo& gravity = row("gravity.y");
  const double start = edits.value(gravity);
  edits.set(gravity, -5);
  edits.set(gravity, -4, true);
  edits.set(gravity, -3, true);
  edits.set(gravity, -1);
  EXPECT_TRUE(edits.undo());
  EXPECT_DOUBLE_EQ(edits.value(gravity), -3);
  EXPECT_TRUE(edits.undo());
  EXPECT_DOUBLE_EQ(edits.value(gravity), start);
  EXPECT_FALSE(edits.undo());
  EXPECT_TRUE(edits.redo());
  EXPECT_TRUE(edits.redo());
  EXPECT_FALSE(edits.redo());
  EXPECT_DOUBLE_EQ(edits.value(gravity), -1);
  EXPECT_TRUE(edits.undo());
  edits.set(row("wind.x"), 3);
  EXPECT_FALSE(edits.redo()) << "a new edit forgets what was undone";
}

TEST(ParameterEdits, APresetIsUndoneAtOnce) {
  ParameterEdits edits{Parameters{}};
  Parameters wanted = edits.values();
  apply_preset(wanted, find_preset("fast"));
  edits.set_all(wanted);
  EXPECT_TRUE(is_set(edits.values(), find_preset("fast")));
  EXPECT_FALSE(is_set(edits.values(), find_preset("accurate")));
  const ParameterInfo& dt = row("step.time_step");
  EXPECT_NE(edits.value(dt), edits.start_value(dt));
  EXPECT_TRUE(edits.undo());
  for (const ParameterInfo& info : parameter_table()) EXPECT_FALSE(edits.changed(info));
  EXPECT_FALSE(edits.undo());
  EXPECT_TRUE(edits.redo());
  EXPECT_TRUE(is_set(edits.values(), find_preset("fast")));
  edits.set_all(edits.values());
  EXPECT_TRUE(edits.undo()) << "nothing changed, nothing to undo";
  EXPECT_FALSE(is_set(edits.values(), find_preset("fast")));
}

TEST(ParameterEdits, TheNewestValuesAreTakenInTheirOrder) {
  ParameterEdits edits{Parameters{}};
  edits.set(row("wind.x"), 1);
  edits.set(row("wind.x"), 2, true);
  edits.set(row("wind.y"), 3);
  edits.undo();
  const auto changes = edits.take_changes();
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_EQ(changes[0], (std::pair<std::string, double>{"wind.x", 2}));
  EXPECT_EQ(changes[1], (std::pair<std::string, double>{"wind.y", 0}));
  EXPECT_TRUE(edits.take_changes().empty());
}

}  // namespace
}  // namespace icloth
