#include "tests/kill_run/supervisor.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <new>
#include <string_view>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "protocol/hardened/endpoint.hpp"

namespace kill_run {

namespace {

namespace hardened = protocol::hardened;
using std::chrono::microseconds;
using std::chrono::nanoseconds;
using namespace std::chrono_literals;

/// More than a kernel writes between two kills.
constexpr std::size_t entries_per_kill = 8192;
constexpr std::size_t entries_least = 1U << 20U;

/// I17: restart, what an old call still takes, the fresh call, and what a busy machine adds to each.
const nanoseconds recovery_bound = call_bound(usual_time_outs) + call_bound(fresh_time_outs) + work_max +
                                   open_timeout + 3 * scheduling_allowance;
constexpr nanoseconds good_order_bound = 20s;

/// From the last start or recovery to a kill from outside; the earliest is a thousandth of the latest.
constexpr microseconds moment_max = 20ms;
/// As long as processes need to fork and to make the named objects, twice over.
constexpr microseconds making_max = 1ms;

constexpr std::array both_roles{Role::kernel, Role::emulator};

std::string_view to_string(Role role) { return role == Role::kernel ? "kernel" : "emulator"; }

std::string to_text(const std::optional<Ending>& ending) {
  if (!ending) return fmt::format("does not end");
  return fmt::format("has ended by itself, {} {}", ending->by_signal ? "by signal" : "with exit code",
                     ending->code);
}

/// The first bytes of the segment, without a part in it.
std::optional<hardened::Phase> phase_now(const std::string& segment_name) {
  const int file = ::shm_open(fmt::format("/{}", segment_name).c_str(), O_RDONLY, 0);
  if (file < 0) return std::nullopt;
  std::uint32_t word = 0;
  const bool has_word = ::pread(file, &word, sizeof word, 0) == sizeof word;
  ::close(file);
  return has_word ? std::optional(hardened::decode(word).phase) : std::nullopt;
}

/// Short waits are spun: the system's are late by more than they are long.
void let_pass(microseconds time) {
  const auto until = Clock::now() + time;
  if (time > 200us) std::this_thread::sleep_until(until - 100us);
  while (Clock::now() < until) {
  }
}

}  // namespace

Supervisor::Supervisor(const RunOptions& options, const std::atomic<bool>& interrupted)
    : options_(options),
      interrupted_(interrupted),
      control_pages_(sizeof(Control)),
      control_(*::new(control_pages_.address()) Control{}),
      kernel_journal_(entries_least + options.kills * entries_per_kill),
      emulator_journal_(entries_least + options.kills * entries_per_kill),
      dice_(options.seed) {}

RunResult Supervisor::run() {
  for (const Role role : both_roles) start(role);
  bool goes_on = true;
  while (goes_on && kills_.size() < options_.kills && !interrupted_.load()) {
    goes_on = was_removed_ || dice_.one_in(2) || recover();
    goes_on = goes_on && kill_and_start_again();
  }
  goes_on = goes_on && !interrupted_.load() && recover();
  if (goes_on) {
    stop_in_good_order();
  } else {
    for (const Role role : both_roles) {
      const auto begin = Clock::now();
      player(role).process->send(SIGKILL);
      bury(role, begin);
    }
  }
  remove_at_the_end();
  result_.was_interrupted = interrupted_.load();

  Accounts accounts = account_for(
      {.kernel = kernel_journal_.entries(), .emulator = emulator_journal_.entries(), .kills = kills_});
  auto& accusations = accounts.accusations;
  accusations.insert(accusations.end(), result_.accounts.accusations.begin(),
                     result_.accounts.accusations.end());
  result_.accounts = std::move(accounts);
  return std::move(result_);
}

std::atomic<std::int32_t>& Supervisor::steps_left(Role role) noexcept {
  return role == Role::kernel ? control_.kernel_steps_left : control_.emulator_steps_left;
}

void Supervisor::start(Role role) {
  Player& started = player(role);
  const Side side{.options = options_,
                  .control = control_,
                  .journal = role == Role::kernel ? kernel_journal_ : emulator_journal_,
                  .incarnation = ++started.incarnation,
                  .seed = dice_.number()};
  started.process = std::make_unique<ChildProcess>(
      [&side, role] { return role == Role::kernel ? run_kernel(side) : run_emulator(side); });
}

bool Supervisor::recover() {
  const std::uint32_t round = control_.wanted_round.load() + 1;
  const auto give_up_at = Clock::now() + recovery_bound;
  control_.wanted_round.store(round);
  while (control_.shown_round.load() != round) {
    if (interrupted_.load()) return false;
    if (has_ended_by_itself(Role::kernel) || has_ended_by_itself(Role::emulator)) return false;
    if (Clock::now() > give_up_at) {
      accuse(fmt::format("I17: no fresh request has ended {} ms after kernel {} and emulator {} were there",
                         recovery_bound / 1ms, player(Role::kernel).incarnation,
                         player(Role::emulator).incarnation));
      return false;
    }
    std::this_thread::sleep_for(20us);
  }
  if (!kills_.empty()) result_.recoveries.push_back(Clock::now() - kills_.back().begin);
  return true;
}

bool Supervisor::kill_and_start_again() {
  const std::vector<Role> victims = draw_victims();
  const bool both = victims.size() == 2;
  // A segment that is made anew: its makers are killed while they make it, before any step of an exchange.
  const microseconds latest = std::exchange(was_removed_, false) ? making_max : moment_max;
  const bool at_a_step = !both && latest == moment_max && dice_.one_in(2);
  if (!(at_a_step ? kill_at_a_step(victims.front()) : kill_at_a_moment(victims, latest))) return false;
  if (both) {
    ++result_.kills_of_both;
    if (!dice_.one_in(4) && !remove_between_lives()) return false;
  }
  for (const Role role : victims) start(role);
  return true;
}

std::vector<Role> Supervisor::draw_victims() {
  switch (options_.victims) {
    case Victims::kernel:
      return {Role::kernel};
    case Victims::emulator:
      return {Role::emulator};
    case Victims::either:
      break;
  }
  if (dice_.one_in(6)) return {Role::kernel, Role::emulator};
  return {dice_.one_in(2) ? Role::kernel : Role::emulator};
}

bool Supervisor::kill_at_a_moment(const std::vector<Role>& victims, microseconds latest) {
  let_pass(microseconds{dice_.log_uniform(latest.count() / 1000, latest.count())});
  std::array<Clock::time_point, 2> begin;
  for (const Role role : victims) {
    begin[index(role)] = Clock::now();
    player(role).process->send(SIGKILL);
  }
  bool all_killed = true;
  for (const Role role : victims) all_killed = bury(role, begin[index(role)]) && all_killed;
  return all_killed;
}

bool Supervisor::kill_at_a_step(Role victim) {
  const auto begin = Clock::now();
  steps_left(victim).store(static_cast<std::int32_t>(dice_.log_uniform(1, 60)));
  // It may wait for a step that the other side has to make first, or pause.
  if (!player(victim).process->wait_for(50ms)) player(victim).process->send(SIGKILL);
  const bool killed = bury(victim, begin);
  if (killed && steps_left(victim).exchange(0) <= 0) ++result_.kills_at_steps;
  return killed;
}

bool Supervisor::bury(Role role, Clock::time_point begin) {
  Player& buried = player(role);
  const auto ending = buried.process->wait_for(good_order_bound);
  const auto phase = phase_now(options_.name);
  if (role == Role::emulator) control_.serving.store(false);
  if (ending != Ending{.by_signal = true, .code = SIGKILL}) {
    accuse_of_ending(role, ending);
    return false;
  }
  kills_.push_back({.role = role, .incarnation = buried.incarnation, .begin = begin, .dead = Clock::now()});
  auto& by_phase = result_.kills.at(index(role));
  ++by_phase.at(phase ? static_cast<std::size_t>(*phase) : by_phase.size() - 1);
  return true;
}

bool Supervisor::has_ended_by_itself(Role role) {
  const auto ending = player(role).process->wait_for(0ns);
  if (ending) accuse_of_ending(role, ending);
  return ending.has_value();
}

void Supervisor::accuse_of_ending(Role role, const std::optional<Ending>& ending) {
  accuse(fmt::format("I17: {} {} {}", to_string(role), player(role).incarnation, to_text(ending)));
}

bool Supervisor::remove_between_lives() {
  ChildProcess remover(
      [this] { return hardened::remove_segment(options_.name, protocol_options(options_)) ? 0 : 1; });
  if (dice_.one_in(2)) {
    let_pass(microseconds{dice_.log_uniform(1, 1000)});
    remover.send(SIGKILL);
  }
  const auto ending = remover.wait_for(good_order_bound);
  ++result_.removals;
  was_removed_ = true;
  if (ending == Ending{.by_signal = true, .code = SIGKILL}) {
    ++result_.removals_killed;
    return true;
  }
  if (ending == Ending{}) return true;
  accuse(fmt::format("I17: the segment could not be removed after kernel {} and emulator {} were killed",
                     player(Role::kernel).incarnation, player(Role::emulator).incarnation));
  return false;
}

void Supervisor::stop_in_good_order() {
  control_.stopping.store(true);
  player(Role::emulator).process->send(SIGTERM);
  for (const Role role : both_roles) {
    const auto ending = player(role).process->wait_for(good_order_bound);
    if (ending != Ending{}) accuse_of_ending(role, ending);
  }
}

void Supervisor::remove_at_the_end() {
  if (const auto removed = hardened::remove_segment(options_.name, protocol_options(options_)); !removed)
    accuse(fmt::format("I17: the segment could not be removed at the end: {}", to_string(removed.error())));
  for (const std::string& left : named_objects(options_))
    accuse(fmt::format("I29: {} is left at the end", left));
}

std::vector<std::string> named_objects(const RunOptions& options) {
  std::vector<std::string> found;
  constexpr std::string_view of_semaphores = "sem.";
  for (const auto& entry : std::filesystem::directory_iterator("/dev/shm")) {
    std::string file = entry.path().filename().string();
    if (file.starts_with(of_semaphores)) file.erase(0, of_semaphores.size());
    if (options.owns_shared_memory || file == options.name ||
        file.starts_with(fmt::format("{}.", options.name)))
      found.push_back(entry.path().string());
  }
  return found;
}

}  // namespace kill_run
