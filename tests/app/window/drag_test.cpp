// Dragging without a window: what the hand does becomes the right events.
#include "app/window/drag.h"

#include <gtest/gtest.h>

namespace icloth {
namespace {

using Kind = InputEvent::Kind;

/// Eye at z = 2 looking towards −z; the pointer moves over the plane at depth 1.
CursorRay ray(double x, double y) { return {{0, 0, 2}, {x, y, -1}, {0, 0, -1}}; }

ClothHit hit(double x, double y, double z, Index face = 4) {
  return {face, {0.2, 0.3, 0.5}, {x, y, z}};
}

void expect_point(Vec3d actual, Vec3d expected) {
  EXPECT_NEAR(norm(actual - expected), 0, 1e-12)
      << actual.x << " " << actual.y << " " << actual.z << " instead of " << expected.x << " "
      << expected.y << " " << expected.z;
}

TEST(Drag, GrabsTheClothExactlyWhereItIsHit) {
  Drag drag;
  drag.set_defaults(0.03, 500);
  drag.begin(ray(0, 0), hit(0, 0, 0));
  const auto events = drag.take_events();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, Kind::grab);
  EXPECT_EQ(events[0].face, 4);
  EXPECT_TRUE(events[0].barycentric == (Vec3d{0.2, 0.3, 0.5}));
  EXPECT_TRUE(events[0].target == (Vec3d{0, 0, 0}));
  EXPECT_DOUBLE_EQ(events[0].radius, 0.03);
  EXPECT_DOUBLE_EQ(events[0].stiffness, 500);
  EXPECT_TRUE(drag.grabbing());
  EXPECT_TRUE(drag.take_events().empty());
}

TEST(Drag, MovesTheHandInThePlaneOfTheScreen) {
  Drag drag;
  drag.begin(ray(0.1, 0), hit(0.2, 0, 0));
  drag.take_events();
  drag.move(ray(0.3, 0.25));
  const auto events = drag.take_events();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, Kind::move);
  expect_point(events[0].target, {0.6, 0.5, 0});
  drag.move(ray(0.3, 0.25));
  EXPECT_TRUE(drag.take_events().empty()) << "a hand that rests sends nothing";
}

TEST(Drag, LetsGoWhenTheButtonGoesUp) {
  Drag drag;
  drag.begin(ray(0, 0), hit(0, 0, 0));
  drag.take_events();
  drag.end();
  const auto events = drag.take_events();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, Kind::release);
  EXPECT_TRUE(drag.handles().empty());
  EXPECT_FALSE(drag.grabbing());
}

TEST(Drag, ParksAndStaysParkedWhenTheButtonGoesUp) {
  Drag drag;
  drag.begin(ray(0, 0), hit(0, 0, 0));
  drag.move(ray(0.5, 0));
  drag.park();
  drag.take_events();
  drag.move(ray(0.9, 0));
  drag.end();
  EXPECT_TRUE(drag.take_events().empty());
  ASSERT_EQ(drag.handles().size(), 1u);
  EXPECT_TRUE(drag.handles()[0].parked);
  expect_point(drag.handles()[0].target, {1, 0, 0});
}

TEST(Drag, TakesAParkedHandleAgainWithoutAJump) {
  Drag drag;
  drag.pin(hit(0, 0, 0));
  drag.take_events();
  drag.begin_handle(1, ray(0.01, 0), false);
  EXPECT_TRUE(drag.take_events().empty()) << "the pointer is beside the handle, nothing moves";
  drag.move(ray(0.11, 0));
  const auto events = drag.take_events();
  ASSERT_EQ(events.size(), 1u);
  expect_point(events[0].target, {0.2, 0, 0});
  drag.end();
  ASSERT_EQ(drag.handles().size(), 1u) << "it was parked before, so it stays";
  EXPECT_TRUE(drag.take_events().empty());
}

TEST(Drag, SelectedHandlesMoveTogether) {
  Drag drag;
  drag.pin(hit(0, 0, 0));
  drag.pin(hit(1, 0, 0));
  drag.pin(hit(2, 0, 0));
  drag.begin_handle(1, ray(0, 0), false);
  drag.end();
  drag.begin_handle(2, ray(0.5, 0), true);
  drag.take_events();
  drag.move(ray(0.5, 0.5));
  EXPECT_EQ(drag.take_events().size(), 2u);
  expect_point(drag.find(1)->target, {0, 1, 0});
  expect_point(drag.find(2)->target, {1, 1, 0});
  expect_point(drag.find(3)->target, {2, 0, 0});
}

TEST(Drag, TheWheelChangesDepthSizeAndStrength) {
  Drag drag;
  drag.set_defaults(0.02, 400);
  drag.begin(ray(0, 0), hit(0, 0, 0));
  drag.take_events();
  drag.change_depth(1, ray(0, 0));
  auto events = drag.take_events();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_LT(events[0].target.z, -0.01) << "away from the eye";

  drag.change_radius(2);
  events = drag.take_events();
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].kind, Kind::release);
  EXPECT_EQ(events[1].kind, Kind::grab);
  EXPECT_GT(events[1].radius, 0.025);
  EXPECT_LT(events[1].target.z, -0.01) << "the target stays";

  drag.change_stiffness(-1);
  events = drag.take_events();
  EXPECT_LT(events.at(1).stiffness, 350);
  for (int k = 0; k < 200; ++k) drag.change_radius(1);
  EXPECT_LE(drag.radius(), find_parameter("grab.radius")->maximum);
}

TEST(Drag, EscapeUndoesTheGrab) {
  Drag drag;
  drag.begin(ray(0, 0), hit(0, 0, 0));
  drag.move(ray(1, 0));
  drag.take_events();
  drag.cancel();
  EXPECT_EQ(drag.take_events().at(0).kind, Kind::release);
  EXPECT_TRUE(drag.handles().empty());

  drag.pin(hit(0, 1, 0));
  drag.begin_handle(1, ray(0, 0.5), false);
  drag.move(ray(1, 0));
  drag.take_events();
  drag.cancel();
  const auto events = drag.take_events();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, Kind::move);
  expect_point(events[0].target, {0, 1, 0});
  EXPECT_TRUE(drag.find(1)->parked);
  EXPECT_FALSE(drag.find(1)->selected);
}

TEST(Drag, ReleasesTheGrabbedTheSelectedOrTheLastHandle) {
  Drag drag;
  for (int k = 0; k < 4; ++k) drag.pin(hit(k, 0, 0));
  drag.take_events();
  drag.release_selected();
  EXPECT_EQ(drag.take_events().at(0).handle, 4) << "nothing selected: the last one";

  drag.begin_handle(1, ray(0, 0), false);
  drag.end();
  drag.begin_handle(2, ray(0, 0), true);
  drag.end();
  drag.release_selected();
  EXPECT_EQ(drag.take_events().size(), 2u);
  ASSERT_EQ(drag.handles().size(), 1u);
  EXPECT_EQ(drag.handles()[0].id, 3);

  drag.begin(ray(0, 0), hit(0, 0, 0));
  const int active = drag.active();
  drag.take_events();
  drag.release_selected();
  EXPECT_EQ(drag.take_events().at(0).handle, active);
  EXPECT_FALSE(drag.grabbing());

  drag.pin(hit(0, 0, 0));
  drag.take_events();
  drag.release_all();
  EXPECT_EQ(drag.take_events().size(), 2u);
  EXPECT_TRUE(drag.handles().empty());
}

TEST(Drag, TheTargetStaysInSpaceWhenTheCameraTurns) {
  Drag drag;
  drag.begin(ray(0.2, 0), hit(0.4, 0, 0));
  drag.take_events();
  const CursorRay turned{{2, 0, 0}, {-1, 0.1, 0.3}, {-1, 0, 0}};
  drag.follow_camera(turned);
  drag.move(turned);
  expect_point(drag.find(1)->target, {0.4, 0, 0});
  CursorRay moved = turned;
  moved.direction.y = 0.2;
  drag.move(moved);
  expect_point(drag.find(1)->target, {0.4, 0.16, 0});
}

TEST(Drag, AfterAJumpInTimeOnlyHeldHandlesRemain) {
  Drag drag;
  drag.pin(hit(0, 0, 0));
  drag.begin(ray(0, 0), hit(1, 0, 0));
  drag.take_events();
  HandleState held;
  held.id = 1;
  held.face = 9;
  held.target = {5, 5, 5};
  HandleState scripted = held;
  scripted.id = kFirstScriptedHandle;
  drag.restore(std::vector{held, scripted});
  ASSERT_EQ(drag.handles().size(), 1u);
  EXPECT_EQ(drag.handles()[0].face, 9);
  EXPECT_TRUE(drag.handles()[0].parked);
  EXPECT_FALSE(drag.grabbing());
  const auto events = drag.take_events();
  ASSERT_EQ(events.size(), 1u) << "a grab that was on its way must not stay for ever";
  EXPECT_EQ(events[0].kind, Kind::release);
  EXPECT_EQ(events[0].handle, 2);
}

TEST(Drag, PinsStayPinsThroughAJumpInTime) {
  Drag drag;
  drag.pin(hit(0, 0, 0));
  drag.begin(ray(0, 0), hit(0.1, 0, 0));
  drag.park();
  std::vector<HandleState> held;
  for (const Handle& handle : drag.handles()) held.push_back({handle, handle.target});
  drag.restore(held);
  ASSERT_EQ(drag.handles().size(), 2u);
  EXPECT_TRUE(drag.handles()[0].pin);
  EXPECT_FALSE(drag.handles()[1].pin);
}

TEST(Drag, ANewGrabGetsAFreeNumber) {
  Drag drag;
  for (int k = 0; k < 1200; ++k) drag.pin(hit(0, 0, 0));
  EXPECT_EQ(drag.handles().size(), 999u) << "1000 and above belong to scripted grabs";
  drag.release(17);
  drag.begin(ray(0, 0), hit(0, 0, 0));
  EXPECT_EQ(drag.active(), 17);
}

TEST(Drag, ARayBesideTheViewStaysFinite) {
  const Vec3d p = point_at_depth({{0, 0, 0}, {1, 0, 0}, {0, 0, -1}}, 1);
  EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
}

}  // namespace
}  // namespace icloth
