// A session under random hands: nothing crashes, goes through anything, or is recorded wrongly.
#include <cstdlib>
#include <random>

#include "tests/app/session/session_support.h"
#include "tests/support/intersections.h"

namespace icloth {
namespace {

using namespace testing;
using Kind = InputEvent::Kind;

/// Asks a session for things that a user can ask for, in random order and without waiting for them.
class Monkey {
 public:
  Monkey(Session& session, unsigned seed) : session_(session), random_(seed) {}

  void act() {
    // Mostly the cloth is played with, so that a run gets somewhere before it is left.
    const Index choice = number(0, 99);
    if (choice < 25) return session_.play();
    if (choice < 55) return use_a_hand();
    if (choice < 65) return session_.step_once();
    if (choice < 70) return session_.pause();
    if (choice < 75) return session_.step_back(at(number(0, 5)));
    if (choice < 80) return session_.preview(at(number(0, 200)));
    if (choice < 82) return session_.go(at(number(0, 200)));
    if (choice < 85) return session_.return_to_left_run();
    if (choice < 88) return session_.set_scripted(number(0, 1) == 1);
    if (choice < 91) return session_.set_real_time(number(0, 3) == 0);
    if (choice < 94) return session_.pass_over();
    if (choice < 99) return change_a_parameter();
    if (number(0, 4) == 0) session_.reset();
  }

 private:
  Index number(Index least, Index most) {
    return std::uniform_int_distribution<Index>(least, most)(random_);
  }
  double real(double least, double most) {
    return std::uniform_real_distribution(least, most)(random_);
  }

  void change_a_parameter() {
    switch (number(0, 4)) {
      case 0:
        return session_.set("step.time_step", real(0.002, 0.02));
      case 1:
        return session_.set("proximity.friction_cloth", real(0, 1));
      case 2:
        return session_.set("gravity.y", real(-30, 10));
      case 3:
        return session_.set("proximity.thickness", real(1e-3, 6e-3));
      default:
        return session_.set("proximity.friction_cloth", real(-2, 0));  // refused with a note
    }
  }

  /// Hands also move and let go of what they do not hold.
  void use_a_hand() {
    const Kind kinds[] = {Kind::grab, Kind::move, Kind::move, Kind::move, Kind::release};
    InputEvent hand = event(kinds[number(0, 4)], number(1, 3),
                            {real(-0.6, 0.6), real(-0.6, 0.6), real(-0.6, 0.6)});
    hand.face = number(0, 239);
    if (number(0, 3) == 0) hand.stiffness = real(1, 1e5);
    session_.post(hand);
  }

  Session& session_;
  std::mt19937 random_;
};

class SessionMonkey : public ::testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, SessionMonkey, ::testing::Values(1, 2, 3),
                         ::testing::PrintToStringParamName());

/// ICLOTH_MONKEY_SECONDS makes it play longer; the seed is part of the test's name.
TEST_P(SessionMonkey, LeavesTheClothWholeAndTheRecordingTrue) {
  using Clock = std::chrono::steady_clock;
  const char* text = std::getenv("ICLOTH_MONKEY_SECONDS");
  const auto end = Clock::now() + std::chrono::duration<double>(text ? std::atof(text) : 2);

  const auto scene = real_scene();
  const SceneFaces soup = scene_faces(*scene);
  const auto session = make_real();
  step(*session, 5);  // so that there is a run to go back in
  Monkey monkey(*session, GetParam());
  std::minstd_rand pauses(GetParam());
  std::size_t looks = 0, refused = 0;
  std::int64_t furthest = 0;
  do {
    monkey.act();
    // Often enough the session gets some steps done before it is asked for something else.
    if (pauses() % 2 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(pauses() % 100));
    if (!session->take()) continue;

    // What the window shows is as good as what a run ends with.
    const PublishedState& state = session->state();
    furthest = std::max(furthest, state.step);
    refused += state.failed;
    if (++looks % 8 != 0 || state.failed) continue;
    std::vector<Vec3d> positions;
    for (const Vec3f& p : state.positions) positions.push_back({p.x, p.y, p.z});
    EXPECT_TRUE(find_intersections(positions, soup.faces, soup.group).empty())
        << "step " << state.step;
  } while (Clock::now() < end);

  session->stop();
  const Recording recording = session->recording();
  std::printf("%zu looks, %zu at a refused step, %lld steps at most, %zu in the end\n", looks,
              refused, static_cast<long long>(furthest), recording.steps.size());
  EXPECT_EQ(replay_with_real(recording), recording.final_hash);
}

}  // namespace
}  // namespace icloth
