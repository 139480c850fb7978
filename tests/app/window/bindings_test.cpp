// The one table of keys and mouse, and the page made from it.
#include "app/window/bindings.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

namespace icloth {
namespace {

Action press(int code, Under under, int modifiers = 0, bool holds = false) {
  return find_action(Trigger::press, code, {modifiers, holds, under});
}
Action strike(int code, int modifiers = 0, bool holds = false) {
  return find_action(Trigger::key, code, {modifiers, holds, Under::other});
}
Action wheel(int modifiers, bool holds) {
  return find_action(Trigger::wheel, 0, {modifiers, holds, Under::cloth});
}

TEST(Bindings, PlainLeftDragGrabsClothAndOrbitsBesideIt) {
  EXPECT_EQ(press(button::kLeft, Under::cloth), Action::grab);
  EXPECT_EQ(press(button::kLeft, Under::handle), Action::grab_handle);
  EXPECT_EQ(press(button::kLeft, Under::other), Action::orbit);
  EXPECT_EQ(press(button::kLeft, Under::handle, modifier::kShift), Action::add_handle);
  EXPECT_EQ(press(button::kLeft, Under::cloth, modifier::kControl), Action::pin_point);
}

TEST(Bindings, MiddleAndRightDragMoveTheCameraAlsoOverCloth) {
  EXPECT_EQ(press(button::kMiddle, Under::cloth), Action::orbit);
  EXPECT_EQ(press(button::kMiddle, Under::cloth, modifier::kShift), Action::pan);
  EXPECT_EQ(press(button::kMiddle, Under::cloth, modifier::kControl), Action::dolly_drag);
  EXPECT_EQ(press(button::kRight, Under::cloth), Action::pan);
}

TEST(Bindings, TheHoldingHandHasItsOwnKeys) {
  EXPECT_EQ(press(button::kRight, Under::cloth, 0, true), Action::park);
  EXPECT_EQ(strike('P', 0, true), Action::park);
  EXPECT_EQ(strike('P'), Action::none);
  EXPECT_EQ(strike(key::kEnter, 0, true), Action::park);
  EXPECT_EQ(wheel(0, true), Action::grab_depth);
  EXPECT_EQ(wheel(0, false), Action::dolly);
  EXPECT_EQ(wheel(modifier::kControl, true), Action::grab_radius);
  EXPECT_EQ(wheel(modifier::kShift, true), Action::grab_stiffness);
}

TEST(Bindings, OnlyControlQQuits) {
  EXPECT_EQ(strike('Q', modifier::kControl), Action::quit);
  EXPECT_EQ(strike(key::kEscape), Action::cancel);
  int quits = 0;
  for (const Binding& row : binding_table()) quits += row.action == Action::quit;
  EXPECT_EQ(quits, 1);
}

TEST(Bindings, TextFieldsLeaveTheKeysThatTheyDoNotNeed) {
  for (const int code : {key::kF1, key::kF5, key::kF12}) EXPECT_FALSE(text_field_takes(code, 0));
  for (const char letter : {'S', 'Q'})
    EXPECT_FALSE(text_field_takes(letter, modifier::kControl)) << letter;
  for (const char letter : {'A', 'C', 'V', 'X', 'Y', 'Z'})
    EXPECT_TRUE(text_field_takes(letter, modifier::kControl)) << letter;
  for (const int code : {int{'S'}, int{'1'}, key::kSpace, key::kEscape, key::kLeft, key::kTab})
    EXPECT_TRUE(text_field_takes(code, 0)) << code;
}

TEST(Bindings, NoRowIsHiddenByOneBeforeIt) {
  const auto table = binding_table();
  for (std::size_t i = 0; i < table.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Binding &a = table[i], &b = table[j];
      const bool same = a.trigger == b.trigger && a.code == b.code && a.modifiers == b.modifiers &&
                        (b.hand == Hand::any || b.hand == a.hand) &&
                        (b.under == Under::any || b.under == a.under);
      EXPECT_FALSE(same) << a.input << " is hidden by " << b.input;
    }
  }
}

TEST(Bindings, EveryRowIsDescribedOrFollowsItsDescription) {
  const Binding* described = nullptr;
  for (const Binding& row : binding_table()) {
    EXPECT_NE(row.action, Action::none);
    if (!row.input.empty()) {
      EXPECT_FALSE(row.text.empty()) << row.input;
      described = &row;
    } else {
      ASSERT_NE(described, nullptr);
      EXPECT_EQ(row.group, described->group);
    }
  }
}

TEST(Bindings, GroupsAreNotTornApart) {
  std::set<std::string_view> seen;
  std::string_view last;
  for (const Binding& row : binding_table()) {
    if (row.group != last) {
      EXPECT_TRUE(seen.insert(row.group).second) << row.group;
      last = row.group;
    }
  }
}

TEST(Bindings, TheHintBarSaysWhatCanBeDoneNow) {
  const std::string free = hint_line(false), holds = hint_line(true);
  EXPECT_NE(free.find("grab"), std::string::npos);
  EXPECT_EQ(free.find("park"), std::string::npos);
  EXPECT_NE(holds.find("park"), std::string::npos);
  EXPECT_NE(holds.find("depth"), std::string::npos);
  EXPECT_LT(free.size(), 140u);
  EXPECT_LT(holds.size(), 140u);
}

TEST(Bindings, ThePageOfKeysIsTheTable) {
  std::ifstream file(ICLOTH_TEST_FOLDER "/../docs/keys.md");
  ASSERT_TRUE(file) << "docs/keys.md is missing";
  std::ostringstream text;
  text << file.rdbuf();
  EXPECT_EQ(text.str(), bindings_markdown());
}

}  // namespace
}  // namespace icloth
