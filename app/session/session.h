// The simulation behind the window: a solver on its own thread, fed through a mailbox.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "app/common/element_names.h"
#include "app/session/hand_paths.h"
#include "app/session/history.h"
#include "app/session/triple_buffer.h"
#include "sim/scene/input.h"
#include "sim/simulator.h"

namespace icloth {

struct SessionOptions {
  std::string scene;                       ///< as it is written into recordings
  std::vector<std::string> overrides;      ///< --set arguments of the scene
  std::size_t history_bytes = 256u << 20;  ///< memory for stepping back
  bool real_time = true;                   ///< never faster than time_step per wall second
  std::vector<FileLayout> layouts;         ///< of the scene's files, for the names of vertices
  std::vector<Recording::Step> ahead;      ///< a recorded run, which go() makes again
  std::string refusal;                     ///< why nothing may run (bad start state); empty: may
  /// Called on the solver's thread when a new state is there; null: nobody waits for it.
  std::function<void()> published;
};

/// The state of the session as the interface thread sees it.
struct PublishedState {
  std::int64_t step = 0;
  double time = 0;  ///< [s]
  /// All vertices [m]. They are needed even when the picture is made from `on_device`, since
  /// picking, handles and the camera work on the host.
  std::vector<Vec3f> positions;
  /// The same on the solver's device; null: it has none. Each slot of the triple buffer has its
  /// own, so the one that is drawn from is not written.
  std::unique_ptr<DevicePositions> on_device;
  std::vector<HandleState>
      handles;                ///< as the solver holds them after the events it has yet to see
  std::uint64_t rewinds = 0;  ///< grows when the state jumps back: handles may be gone
  StepReport report;          ///< of the newest step
  Parameters parameters;
  bool playing = false;
  bool scripted = false, real_time = true;
  double steps_per_second = 0;
  std::size_t history = 0;  ///< steps that can be taken back
  std::size_t ahead = 0;    ///< steps that were taken back and can be made again
  std::size_t left = 0;     ///< steps of the run that was left last (Session::return_to_left_run)
  std::size_t history_bytes = 0;
  bool preview = false;        ///< the positions are those of an older state (Session::preview)
  bool failed = false;         ///< the newest step was refused, or nothing may run
  bool may_pass_over = false;  ///< the newest step was refused, and the clock can go on over it
  std::string failure;         ///< plain sentence
  std::uint64_t notes = 0;     ///< grows with every new note
  std::string note;            ///< e.g. "session saved to …"
  bool note_is_bad = false;    ///< it tells of something that went wrong
};

/// Owns the simulator. Every public member is called from one thread (the interface) and returns
/// at once; a step in progress is never waited for, except by stop().
class Session {
 public:
  Session(std::unique_ptr<Simulator> simulator, SessionOptions options);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  void play();
  void pause();
  void step_once();  ///< one step, then pause
  void step_back(std::size_t count = 1);
  /// To the state after so many recorded steps, back, or forward along those that were taken back.
  /// Where that state is not kept, the steps to it are made again; whatever is asked for meanwhile
  /// ends that early.
  void go(std::size_t steps);
  /// Shows the positions of the newest kept state that is not after so many steps, until the next
  /// state is published; the run stays where it is.
  void preview(std::size_t steps);
  /// Goes to the end of the run that was left last, when the cloth went on from an older state or
  /// was reset. The present run becomes the one that was left.
  void return_to_left_run();
  /// Lets the clock go on over the step that was just refused (Simulator::pass_over), as
  /// `--on-failure continue` does; says in a note what that did.
  void pass_over();
  void reset();                ///< to the start state; parameters stay
  void set_scripted(bool on);  ///< apply the scene's scripted grabs as well
  void set_real_time(bool on);
  void save(const std::string& path);  ///< writes the recording; tells in a note how it went
  void post(const InputEvent& event);  ///< for the next step
  void set(const std::string& parameter, double value);

  /// Moves state() to the newest published one; false when nothing new was published.
  bool take() { return published_.take(); }
  const PublishedState& state() const { return published_.front(); }
  /// Reports of all steps since the last call, oldest first (the newest 4096 when not asked long).
  std::vector<StepReport> take_reports();

  /// How long the step in progress has been taking [s], 0 between steps.
  double step_seconds() const;

  /// Ends the thread after the step in progress. The recording is complete then.
  void stop();
  /// Only after stop().
  Recording recording() const;

 private:
  using Clock = std::chrono::steady_clock;
  enum class Command { play, pause, step, pass_over, reset, left_run, stop };
  struct Back {
    std::size_t count;
  };
  struct Go {
    std::size_t steps;
  };
  struct Preview {
    std::size_t steps;
  };
  struct Toggle {
    bool scripted;
    bool on;
  };
  struct Save {
    std::string path;
  };
  struct Change {
    std::string parameter;
    double value;
  };
  using Mail = std::variant<Command, Back, Go, Preview, Toggle, Save, Change, InputEvent>;

  /// Input of a whole run, and how many of its first steps the recording has as well.
  struct Run {
    std::vector<Recording::Step> steps;
    std::size_t shared = 0;
  };

  void send(Mail mail);

  // These run on the solver thread.
  void run();
  void wait_for_mail(std::vector<Mail>& mail);
  void handle(Command command);
  void handle(const Back& back);
  void handle(const Go& go);
  void handle(const Preview& preview);
  void handle(const Toggle& toggle);
  void handle(const Save& save);
  void handle(const Change& change);
  void handle(const InputEvent& event);
  void advance();
  void pass_refused_step();
  Recording::Step next_step();
  void start_script();
  void release_scripted_handles();
  void finish(const StepReport& report);
  Run present_run() const;
  void leave_run();
  void change_runs();
  void travel(std::size_t target, const Run& run);
  void restore(const HistoryEntry& entry, const Run& run);
  void make_again(const Recording::Step& step);
  void keep_state();
  void settle();
  bool has_mail();
  void explain_refusal();
  void fail(const std::string& sentence);
  bool may_pass_over() const { return failed_ && !refused() && !recording_.steps.empty(); }
  void note(const std::string& text, bool bad = false);
  void publish(bool always);
  void fill(PublishedState& state) const;
  void hand_over();
  void read_positions(PublishedState& state);
  template <class Work>
  bool guarded(const Work& work);
  bool refused() const { return !options_.refusal.empty(); }

  std::unique_ptr<Simulator> simulator_;
  SessionOptions options_;

  // Both threads use these.
  std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<Mail> mailbox_;       ///< under mutex_
  std::deque<StepReport> reports_;  ///< under mutex_, at most 4096
  TripleBuffer<PublishedState> published_;
  std::atomic<Clock::rep> step_begin_{0};  ///< of the step in progress, 0: none

  // Only the solver thread uses these.
  bool playing_ = false, stopping_ = false, scripted_ = false, single_ = false;
  HandPaths hands_;  ///< events for the steps to come
  std::optional<ScriptedInput> script_;
  Parameters wanted_parameters_;    ///< for the next step
  bool follows_run_ = false;        ///< a loaded run decides the settings, until one is touched
  Parameters recorded_parameters_;  ///< in force at the end of the recording
  Recording recording_;
  std::vector<Recording::Step> ahead_;  ///< taken back, of the same run
  Run left_;                            ///< that was left last
  HistoryEntry start_;
  History history_;
  StepReport report_;
  std::vector<Vec3f> positions_;  ///< newest of the simulator [m] (V), read_positions
  bool failed_ = false;
  std::string failure_;
  std::uint64_t rewinds_ = 0, notes_ = 0;
  std::string note_;
  bool note_is_bad_ = false;
  Clock::time_point due_{}, last_published_{};
  std::deque<Clock::time_point> step_ends_;  ///< of the last second

  std::thread thread_;  ///< last: starts when all else is there
};

/// Why a step was refused, for people. `names` are those of the scene's elements; `too_close`: the
/// numbers of the build do not tell layers apart.
std::string failure_sentence(const StepReport& report, const Scene& scene,
                             const ElementNames& names, bool too_close);

}  // namespace icloth
