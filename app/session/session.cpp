#include "app/session/session.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <utility>

#include "app/common/headless.h"

namespace icloth {

namespace {

constexpr std::size_t kMaxReports = 4096;
constexpr auto kPublishInterval = std::chrono::milliseconds(4);

InputEvent release_of(int handle) {
  InputEvent event;
  event.kind = InputEvent::Kind::release;
  event.handle = handle;
  return event;
}

/// The fault of a step, and the remedy.
struct Failure {
  std::string what, remedy;
};

Failure failure_of(const StepReport& report, const Scene& scene, const ElementNames& names,
                   bool too_close) {
  const std::string collisions = std::to_string(report.impacts_left) +
                                 (report.impacts_left == 1 ? " collision" : " collisions");
  if (!report.finite)
    return {"gave numbers that are not finite, so it was thrown away",
            "A smaller time step usually helps."};

  if (too_close)
    return {"was refused: layers are closer than single precision resolves (" + collisions + ")",
            "The layers have to be further apart, or the program has to be started with "
            "--precision f64."};

  // Bodies may leave the cloth no room, above all where it is pinned.
  const std::string pins = pins_in_the_way(scene, names, report);
  if (!pins.empty())
    return {"was refused: " + pins + " (" + collisions + ")",
            "The body has to stay away from what is pinned, or the pins have to go."};
  if (report.no_room)
    return {"was refused: moving bodies leave the cloth no room (" + collisions + ")",
            "The bodies have to be further apart, or the thickness smaller."};
  return {"was refused: " + collisions + " could not be resolved in " +
              std::to_string(report.rounds) + " rounds",
          "Let go of the handles, or go on with a smaller time step."};
}

}  // namespace

std::string failure_sentence(const StepReport& report, const Scene& scene,
                             const ElementNames& names, bool too_close) {
  const Failure failure = failure_of(report, scene, names, too_close);
  char time[32];
  std::snprintf(time, sizeof time, "%.3f", report.time);
  return "The step at " + std::string(time) + " s " + failure.what +
         ". The cloth is where it was before" +
         (report.finite ? " and nothing has passed through. " : ". ") + failure.remedy;
}

Session::Session(std::unique_ptr<Simulator> simulator, SessionOptions options)
    : simulator_(std::move(simulator)),
      options_(std::move(options)),
      wanted_parameters_(simulator_->parameters()),
      recorded_parameters_(wanted_parameters_),
      history_(options_.history_bytes) {
  recording_.scene = options_.scene;
  recording_.build = build_name(simulator_->build());
  recording_.overrides = options_.overrides;
  follows_run_ = !options_.ahead.empty();
  ahead_ = std::move(options_.ahead);
  start_.snapshot = simulator_->snapshot();
  start_.parameters = recorded_parameters_;
  simulator_->positions(positions_);
  if (refused()) fail(options_.refusal);
  publish(true);
  published_.take();
  thread_ = std::thread([this] { run(); });
}

Session::~Session() { stop(); }

// ---- interface thread --------------------------------------------------------------------------

void Session::send(Mail mail) {
  {
    const std::lock_guard lock(mutex_);
    mailbox_.push_back(std::move(mail));
  }
  wake_.notify_one();
}

void Session::play() { send(Command::play); }
void Session::pause() { send(Command::pause); }
void Session::step_once() { send(Command::step); }
void Session::step_back(std::size_t count) { send(Back{count}); }
void Session::go(std::size_t steps) { send(Go{steps}); }
void Session::preview(std::size_t steps) { send(Preview{steps}); }
void Session::return_to_left_run() { send(Command::left_run); }
void Session::pass_over() { send(Command::pass_over); }
void Session::reset() { send(Command::reset); }
void Session::set_scripted(bool on) { send(Toggle{true, on}); }
void Session::set_real_time(bool on) { send(Toggle{false, on}); }
void Session::save(const std::string& path) { send(Save{path}); }
void Session::post(const InputEvent& event) { send(event); }
void Session::set(const std::string& parameter, double value) { send(Change{parameter, value}); }

std::vector<StepReport> Session::take_reports() {
  std::deque<StepReport> taken;
  {
    const std::lock_guard lock(mutex_);
    taken.swap(reports_);
  }
  return {std::make_move_iterator(taken.begin()), std::make_move_iterator(taken.end())};
}

double Session::step_seconds() const {
  const Clock::rep begin = step_begin_.load();
  if (begin == 0) return 0;
  return std::chrono::duration<double>(Clock::now().time_since_epoch() - Clock::duration(begin))
      .count();
}

void Session::stop() {
  if (!thread_.joinable()) return;
  send(Command::stop);
  thread_.join();
}

Recording Session::recording() const {
  Recording copy = recording_;
  copy.final_hash = simulator_->state_hash();
  return copy;
}

// ---- solver thread -----------------------------------------------------------------------------

/// Whatever the simulator throws ends its work, not the program: a lost device above all.
template <class Work>
bool Session::guarded(const Work& work) {
  try {
    work();
    return true;
  } catch (const std::exception& error) {
    // The first reason counts: what fails after it is only a consequence.
    if (!refused()) options_.refusal = std::string("The solver stopped: ") + error.what();
    playing_ = single_ = false;
    step_begin_ = 0;
    fail(options_.refusal);
    return false;
  }
}

void Session::run() {
  std::vector<Mail> mail;
  while (!stopping_) {
    wait_for_mail(mail);
    for (const Mail& item : mail) {
      guarded([&] { std::visit([this](const auto& content) { handle(content); }, item); });
    }

    // Commands such as reset change the state without a step, and the window shows it at once.
    const bool idle = !playing_ && !single_;
    const bool shows_preview = !mail.empty() && std::holds_alternative<Preview>(mail.back());
    if (!mail.empty() && idle && !shows_preview) publish(true);
    mail.clear();

    if (stopping_ || idle) continue;
    if (single_ || Clock::now() >= due_) advance();
  }
}

void Session::wait_for_mail(std::vector<Mail>& mail) {
  std::unique_lock lock(mutex_);
  const auto arrived = [this] { return !mailbox_.empty(); };
  if (single_) {
    // The asked-for step comes first; mail is looked at without waiting.
  } else if (!playing_) {
    wake_.wait(lock, arrived);
  } else if (options_.real_time) {
    wake_.wait_until(lock, due_, arrived);
  }
  mail.swap(mailbox_);
}

void Session::handle(Command command) {
  // After a start that intersects, or a solver that stopped, nothing may run any more.
  switch (command) {
    case Command::play:
      if (!playing_) due_ = Clock::now();
      playing_ = !refused();
      break;
    case Command::pause:
      playing_ = false;
      break;
    case Command::step:
      playing_ = false;
      single_ = !refused();
      break;
    case Command::pass_over:
      pass_refused_step();
      break;
    case Command::reset:
      if (const Run run = present_run(); !run.steps.empty()) left_ = {run.steps, 0};
      history_.clear();
      travel(0, {});
      break;
    case Command::left_run:
      change_runs();
      break;
    case Command::stop:
      stopping_ = true;
      break;
  }
}

void Session::handle(const Back& back) {
  const std::size_t made = recording_.steps.size();
  playing_ = false;
  if (made == 0) return note("There is no older state to go back to.");
  travel(made - std::min(back.count, made), present_run());
}

void Session::handle(const Go& go) { travel(go.steps, present_run()); }

void Session::handle(const Preview& preview) {
  // At its own place the slider shows the present state.
  playing_ = single_ = false;
  const HistoryEntry* entry =
      preview.steps == recording_.steps.size() ? nullptr : history_.before(preview.steps);
  if (!entry) return publish(true);

  // The kept positions stand in for those of the simulator, which stays where it is.
  PublishedState& state = published_.back();
  fill(state);
  state.step = entry->snapshot.step;
  state.time = entry->snapshot.time;
  state.positions = entry->positions;
  state.on_device.reset();
  state.handles.clear();
  state.preview = true;
  hand_over();
}

void Session::handle(const Toggle& toggle) {
  if (!toggle.scripted) {
    options_.real_time = toggle.on;
    due_ = Clock::now();
    return;
  }
  scripted_ = toggle.on;
  script_.reset();
  if (scripted_)
    start_script();
  else
    release_scripted_handles();
}

void Session::handle(const Save& save) {
  try {
    save_recording(recording(), save.path);
    note("Session saved to " + save.path + " (" + std::to_string(recording_.steps.size()) +
         " steps). Run it again with: icloth replay " + save.path);
  } catch (const std::exception& error) {
    note(std::string("The session was not saved: ") + error.what(), true);
  }
}

void Session::handle(const Change& change) {
  const ParameterInfo* info = find_parameter(change.parameter);
  if (!info) return note("There is no parameter " + change.parameter + ".");
  try {
    set_parameter(wanted_parameters_, *info, change.value);
    follows_run_ = false;
  } catch (const std::exception& error) {
    note(error.what(), true);
  }
}

void Session::handle(const InputEvent& event) { hands_.post(event, simulator_->time()); }

/// The events and the changes of parameters of the next step, as they will be recorded. The
/// simulator gets the parameters only here, as in a replay: a value that was tried between two
/// steps leaves no trace.
Recording::Step Session::next_step() {
  Recording::Step step;

  // A parameter is recorded when it differs from what the recording has led to.
  for (const ParameterInfo& info : parameter_table()) {
    const double wanted = get_parameter(wanted_parameters_, info);
    if (wanted != get_parameter(recorded_parameters_, info))
      step.parameters.emplace_back(info.name, wanted);
  }
  if (!step.parameters.empty()) simulator_->set_parameters(wanted_parameters_);

  // Scripted events are recorded with the user's, so a replay does not need the script.
  const double time = simulator_->time(), dt = wanted_parameters_.step.time_step;
  step.events = hands_.events(time, dt);
  if (script_) {
    for (const InputEvent& event : script_->events(time, dt)) step.events.push_back(event);
  }
  return step;
}

/// From the present time on. Grabs that an older state holds are not made once more.
void Session::start_script() {
  script_.emplace(simulator_->scene());
  for (const HandleState& handle : simulator_->handles()) script_->go_on_holding(handle.id);
}

void Session::release_scripted_handles() {
  for (const HandleState& handle : simulator_->handles())
    if (handle.id >= kFirstScriptedHandle) hands_.post(release_of(handle.id), simulator_->time());
}

void Session::advance() {
  single_ = false;
  leave_run();
  const Clock::time_point begin = Clock::now();
  Recording::Step step;
  const bool done = guarded([&] {
    keep_state();
    step = next_step();
    step_begin_ = begin.time_since_epoch().count();
    report_ = simulator_->step(step.events);
  });
  if (!done) return publish(true);

  // The step took place, whether it was accepted or not, so a replay has to make it too.
  step_begin_ = 0;
  recorded_parameters_ = wanted_parameters_;
  recording_.steps.push_back(std::move(step));
  const auto interval = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(recorded_parameters_.step.time_step));
  due_ = options_.real_time ? std::max(due_ + interval, begin) : begin;
  finish(report_);
}

void Session::finish(const StepReport& report) {
  // The speed is that of the last second.
  const Clock::time_point now = Clock::now();
  step_ends_.push_back(now);
  while (step_ends_.size() > 2 && now - step_ends_.front() > std::chrono::seconds(1)) {
    step_ends_.pop_front();
  }

  // The interface takes the reports with its next frame.
  {
    const std::lock_guard lock(mutex_);
    reports_.push_back(report);
    if (reports_.size() > kMaxReports) reports_.pop_front();
  }

  // What the step has to say to people is shown as one note.
  std::string notes;
  for (const std::string& line : report.notes) notes += (notes.empty() ? "" : "; ") + line;
  if (!notes.empty()) note(notes);

  // A refused step stops the run, and its reason is shown.
  failed_ = !report.accepted;
  if (failed_) {
    playing_ = false;
    guarded([&] { explain_refusal(); });
  }
  publish(!playing_);
}

/// Says why the newest step was refused.
void Session::explain_refusal() {
  const Scene& scene = simulator_->scene();
  fail(failure_sentence(report_, scene, ElementNames(scene, options_.layouts),
                        is_too_close(*simulator_, report_)));
}

/// A replay makes the step as well, meets the same refusal, and passes over it.
void Session::pass_refused_step() {
  if (!may_pass_over()) return note("There is no refused step to pass over.");
  const std::string text = pass_over_step(*simulator_);
  recording_.steps.back().passed_over = true;
  failed_ = false;
  failure_.clear();

  // The report is about the new state, which was not stepped to.
  report_ = {};
  report_.step = simulator_->step_index();
  report_.time = simulator_->time();
  note("The clock " + text + ".");
}

/// All that was recorded: the steps up to the present state, and those that were taken back.
Session::Run Session::present_run() const {
  Run run{recording_.steps, recording_.steps.size()};
  run.steps.insert(run.steps.end(), ahead_.begin(), ahead_.end());
  return run;
}

/// A new step after others were taken back leaves the run of those.
void Session::leave_run() {
  const std::size_t made = recording_.steps.size();
  if (ahead_.empty()) return;
  left_ = present_run();
  ahead_.clear();
  history_.forget_after(made);
}

void Session::change_runs() {
  if (left_.steps.empty()) return note("There is no other run to go back to.");
  Run present = present_run();
  const Run other = std::move(left_);

  // States beyond the steps that both share are those of the present run.
  present.shared = other.shared;
  left_ = std::move(present);
  history_.forget_after(other.shared);
  travel(other.steps.size(), other);
}

/// Makes the state after `target` steps of a run, from the newest one before it that is at hand.
void Session::travel(std::size_t target, const Run& run) {
  playing_ = single_ = false;
  target = std::min(target, run.steps.size());
  const HistoryEntry* kept = history_.before(target);
  const HistoryEntry& nearest = kept ? *kept : start_;
  const std::size_t made = recording_.steps.size();
  const bool is_on_the_way = made <= run.shared && made <= target && made >= nearest.recorded_steps;
  if (!is_on_the_way) restore(HistoryEntry(nearest), run);

  while (recording_.steps.size() < target && !has_mail())
    make_again(run.steps[recording_.steps.size()]);
  if (follows_run_) wanted_parameters_ = recorded_parameters_;
  ahead_.assign(run.steps.begin() + static_cast<std::ptrdiff_t>(recording_.steps.size()),
                run.steps.end());
  settle();
}

/// The simulator becomes what it was: parameters, state and hands. Parameters that the user has
/// changed since are set again with the next step.
void Session::restore(const HistoryEntry& entry, const Run& run) {
  simulator_->set_parameters(entry.parameters);
  simulator_->restore(entry.snapshot);
  recording_.steps.assign(run.steps.begin(),
                          run.steps.begin() + static_cast<std::ptrdiff_t>(entry.recorded_steps));
  recorded_parameters_ = entry.parameters;

  // The report of the newest step does not fit the older state.
  report_ = {};
  report_.step = entry.snapshot.step;
  report_.time = entry.snapshot.time;
}

/// Keeps the state before a step, to which going back returns.
void Session::keep_state() {
  HistoryEntry entry{simulator_->snapshot(), recording_.steps.size(), recorded_parameters_};
  simulator_->positions(entry.positions);
  history_.push(std::move(entry));
}

/// Makes a recorded step once more; equal input gives equal bits.
void Session::make_again(const Recording::Step& step) {
  keep_state();
  apply_changes(step, recorded_parameters_);
  if (!step.parameters.empty()) simulator_->set_parameters(recorded_parameters_);

  // What was passed over then is passed over now.
  step_begin_ = Clock::now().time_since_epoch().count();
  report_ = simulator_->step(step.events);
  step_begin_ = 0;
  recording_.steps.push_back(step);
  if (!report_.accepted && step.passed_over) {
    simulator_->pass_over();
    report_.accepted = true;
  }
  publish(false);
}

/// The hands of a state that was gone to, and what is to be said of it.
void Session::settle() {
  // A scene's own grabs go on only where they are switched on now.
  hands_.clear();
  if (scripted_)
    start_script();
  else
    release_scripted_handles();
  step_ends_.clear();
  failed_ = refused();
  if (!failed_) failure_.clear();
  if (!failed_ && !report_.accepted) explain_refusal();
  ++rewinds_;
}

bool Session::has_mail() {
  const std::lock_guard lock(mutex_);
  return !mailbox_.empty();
}

void Session::fail(const std::string& sentence) {
  failed_ = true;
  failure_ = sentence;
}

void Session::note(const std::string& text, bool bad) {
  note_ = text;
  note_is_bad_ = bad;
  ++notes_;
}

/// Publishes the positions and handles. After the device is lost, the last positions stay.
void Session::read_positions(PublishedState& state) {
  const bool is_read = guarded([&] {
    simulator_->positions_on_device(state.on_device);  // first: the other one waits for the device
    simulator_->positions(positions_);
    state.handles = simulator_->handles();
  });

  if (!is_read) {
    if (state.on_device) state.on_device->failure = "the solver stopped";
    state.handles.clear();
  }
  state.positions = positions_;

  // Events on their way count already: who sees a jump in time must not lose a grab made after it.
  hands_.apply_to(state.handles);
}

/// A fast solver does not publish every step: nobody sees more than the screen shows.
void Session::publish(bool always) {
  const Clock::time_point now = Clock::now();
  if (!always && now - last_published_ < kPublishInterval) return;
  last_published_ = now;

  PublishedState& state = published_.back();
  fill(state);
  read_positions(state);
  hand_over();
}

/// Makes the state that was filled the newest one, and tells who waits for it.
void Session::hand_over() {
  published_.publish();
  if (options_.published) options_.published();
}

/// Writes what the reader learns besides the positions: the state, and how it came about.
void Session::fill(PublishedState& state) const {
  state.step = simulator_->step_index();
  state.time = simulator_->time();
  state.preview = false;
  state.rewinds = rewinds_;
  state.report = report_;
  state.parameters = wanted_parameters_;
  state.playing = playing_;
  state.scripted = scripted_;
  state.real_time = options_.real_time;

  // It also gets the speed, the history, and news for the user.
  const std::size_t count = step_ends_.size();
  const double span =
      count < 2 ? 0 : std::chrono::duration<double>(step_ends_.back() - step_ends_.front()).count();
  state.steps_per_second = playing_ && span > 0 ? static_cast<double>(count - 1) / span : 0;
  state.history = recording_.steps.size();
  state.ahead = ahead_.size();
  state.left = left_.steps.size() - std::min(left_.steps.size(), left_.shared);
  state.history_bytes = history_.bytes();
  state.failed = failed_;
  state.may_pass_over = may_pass_over();
  state.failure = failure_;
  state.notes = notes_;
  state.note = note_;
  state.note_is_bad = note_is_bad_;
}

}  // namespace icloth
