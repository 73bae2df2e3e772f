// What an exchange costs: the round trip of one request and its answer between two real processes, of the published
// handoff and of the hardened one, beside a bare ping-pong of two semaphores with the same bytes.
//
//   handoff_bench [--rounds N] [--exchanges N]     N exchanges of each in turn, in N rounds
//
// All are measured in turn, round after round, so that what the machine does besides hits all alike. Figures depend on
// the machine; ratios less so.
//
// Who waits how decides most. A side that sleeps on a semaphore has to be woken; one that polls without a pause is there at
// once, and costs a core; one that pauses between two looks finds the answer that much later. So each is compared with its
// like:
//   sleeps         the master sleeps until it is woken: two semaphores, and two doorbells
//   polls, 1 ms    pauses for the published poll_interval
//   polls          looks again at once
// The slave sleeps on its semaphore in all of them.

#include <sched.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "protocol/check.hpp"
#include "protocol/hardened/master.hpp"
#include "protocol/hardened/slave.hpp"
#include "protocol/master_shared_memory_wrapper.hpp"
#include "protocol/slave_shared_memory_wrapper.hpp"

namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;
using protocol::ExchangeMaster;
using protocol::ExchangeSlave;
namespace hardened = protocol::hardened;

constexpr std::size_t payload_bytes_max = 512;
using Buffer = std::array<std::byte, payload_bytes_max>;

/// Two semaphores and two areas, and no protocol: what is left of an exchange when nothing may go wrong.
struct PingPong {
  sem_t ping;
  sem_t pong;
  std::size_t ping_bytes;
  std::size_t pong_bytes;
  Buffer ping_area;
  Buffer pong_area;
};

class BareMaster final : public ExchangeMaster {
 public:
  explicit BareMaster(PingPong& shared) : shared_(shared) {}

  [[nodiscard]] tl::expected<void, protocol::SharedMemoryError> open() noexcept override { return {}; }
  void close() noexcept override {}
  [[nodiscard]] bool is_open() const noexcept override { return true; }
  [[nodiscard]] tl::expected<void, protocol::SharedMemoryError> write(
      std::span<const std::byte> request) noexcept override {
    std::memcpy(shared_.ping_area.data(), request.data(), request.size());
    shared_.ping_bytes = request.size();
    ::sem_post(&shared_.ping);
    return {};
  }
  [[nodiscard]] tl::expected<std::size_t, protocol::SharedMemoryError> get_response(
      std::span<std::byte> into) noexcept override {
    ::sem_wait(&shared_.pong);
    std::memcpy(into.data(), shared_.pong_area.data(), shared_.pong_bytes);
    return shared_.pong_bytes;
  }
  void set_timeouts(std::chrono::nanoseconds /*take*/, std::chrono::nanoseconds /*read*/) noexcept override {}
  [[nodiscard]] std::size_t response_bytes_max() const noexcept override { return payload_bytes_max; }

 private:
  PingPong& shared_;
};

class BareSlave final : public ExchangeSlave {
 public:
  explicit BareSlave(PingPong& shared) : shared_(shared) {}

  [[nodiscard]] tl::expected<void, protocol::SharedMemoryError> open() noexcept override { return {}; }
  void close() noexcept override {}
  [[nodiscard]] bool wait_for_request() noexcept override { return ::sem_wait(&shared_.ping) == 0; }
  [[nodiscard]] std::span<const std::byte> read_request() noexcept override {
    request_ = shared_.ping_area;
    return std::span(request_).first(shared_.ping_bytes);
  }
  void write_response(std::span<const std::byte> response) noexcept override {
    std::memcpy(shared_.pong_area.data(), response.data(), response.size());
    shared_.pong_bytes = response.size();
    ::sem_post(&shared_.pong);
  }
  void request_stop() noexcept override {}

 private:
  PingPong& shared_;
  Buffer request_;
};

/// @param process  0: the caller
void pin(pid_t process, int core) noexcept {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(core, &cores);
  ::sched_setaffinity(process, sizeof cores, &cores);
}

/// The slave's process: answers with the bytes of the request, until it is killed.
class Echo {
 public:
  explicit Echo(const std::function<std::unique_ptr<ExchangeSlave>()>& make_slave) : process_(::fork()) {
    if (process_ != 0) return;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    const auto slave = make_slave();
    while (slave->wait_for_request()) slave->write_response(slave->read_request());
    ::_exit(1);
  }
  Echo(const Echo&) = delete;
  Echo& operator=(const Echo&) = delete;
  void stay_on(int core) const noexcept { pin(process_, core); }
  ~Echo() {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }

 private:
  pid_t process_;
};

/// One way to exchange, with its slave.
struct Contestant {
  std::string_view name;
  std::string_view waits;
  std::unique_ptr<ExchangeMaster> master;
  std::unique_ptr<Echo> echo;
  std::function<void()> remove_objects;
  std::vector<std::chrono::nanoseconds> round_trips;

  /// @return whether the answer was the request
  [[nodiscard]] bool exchange(std::span<const std::byte> request) noexcept {
    Buffer answer;
    const auto begin = Clock::now();
    const bool written = master->write(request).has_value();
    const auto count = master->get_response(answer);
    round_trips.push_back(Clock::now() - begin);
    return written && count == request.size() && std::ranges::equal(std::span(answer).first(*count), request);
  }
};

std::string segment_name(int number) { return fmt::format("ltsim-handoff-bench-{}-{}", ::getpid(), number); }

Contestant bare() {
  void* const pages =
      ::mmap(nullptr, sizeof(PingPong), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  PLC_CHECK(pages != MAP_FAILED);
  auto* const shared = ::new (pages) PingPong{};
  PLC_CHECK(::sem_init(&shared->ping, 1, 0) == 0 && ::sem_init(&shared->pong, 1, 0) == 0);
  return {.name = "two semaphores",
          .waits = "sleeps",
          .master = std::make_unique<BareMaster>(*shared),
          .echo = std::make_unique<Echo>([shared] { return std::make_unique<BareSlave>(*shared); }),
          .remove_objects = [shared] { ::munmap(shared, sizeof(PingPong)); },
          .round_trips = {}};
}

Contestant paper(int number, std::chrono::nanoseconds poll_interval) {
  protocol::PaperOptions options;
  options.read_timeout = 10s;
  options.poll_interval = poll_interval;
  const std::string name = segment_name(number);
  return {.name = "paper",
          .waits = poll_interval == 0ns ? "polls" : "polls, 1 ms",
          .master = std::make_unique<protocol::MasterSharedMemoryWrapper>(name, options),
          .echo = std::make_unique<Echo>([&] {
            auto slave = std::make_unique<protocol::SlaveSharedMemoryWrapper>(name, options);
            PLC_CHECK(slave->open());
            return slave;
          }),
          .remove_objects = [name] { protocol::SharedMemoryWrapper::remove(name); },
          .round_trips = {}};
}

Contestant hardened_one(int number, hardened::Options::Doorbells doorbells,
                        std::chrono::nanoseconds poll_interval = 0ns) {
  hardened::Options options;
  options.doorbells = doorbells;
  options.take_timeout = 10s;
  options.answer_timeout = 10s;
  options.poll_interval = poll_interval;
  const std::string name = segment_name(number);
  const bool sleeps = doorbells == hardened::Options::Doorbells::two;
  return {.name = sleeps ? "hardened, two doorbells" : "hardened, one doorbell",
          .waits = sleeps                 ? "sleeps"
                   : poll_interval == 0ns ? "polls"
                                          : "polls, 1 ms",
          .master = std::make_unique<hardened::Master>(name, options),
          .echo = std::make_unique<Echo>([&] {
            auto slave = std::make_unique<hardened::Slave>(name, options);
            PLC_CHECK(slave->open());
            return slave;
          }),
          .remove_objects = [name] { static_cast<void>(hardened::remove_segment(name)); },
          .round_trips = {}};
}

double microseconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double, std::micro>(time).count();
}

/// @param thousandths  500: the median
double quantile(std::vector<std::chrono::nanoseconds> times, std::size_t thousandths) {
  const auto found = times.begin() + static_cast<std::ptrdiff_t>((times.size() - 1) * thousandths / 1000);
  std::ranges::nth_element(times, found);
  return microseconds(*found);
}

void print(std::span<const Contestant> contestants, std::size_t payload_bytes) {
  fmt::print(
      "{} bytes, us                            count    median      99 %   / two semaphores   / paper, same "
      "wait\n",
      payload_bytes);
  std::map<std::string_view, double> paper_medians;
  for (const Contestant& one : contestants) {
    if (one.name == "paper") paper_medians[one.waits] = quantile(one.round_trips, 500);
  }
  const double bare_median = quantile(contestants.front().round_trips, 500);
  for (const Contestant& one : contestants) {
    const double median = quantile(one.round_trips, 500);
    const auto like = paper_medians.find(one.waits);
    fmt::print("  {:<24} {:<12} {:>7} {:>9.2f} {:>9.2f}   {:>16.2f}   {:>18}\n", one.name, one.waits,
               one.round_trips.size(), median, quantile(one.round_trips, 990), median / bare_median,
               like == paper_medians.end() ? "" : fmt::format("{:.2f}", median / like->second));
  }
}

/// @return whether each answer was its request
bool measure(std::span<Contestant> contestants, std::size_t payload_bytes, unsigned rounds,
             unsigned exchanges) {
  const std::vector<std::byte> request(payload_bytes, std::byte{0x55});
  for (Contestant& one : contestants) one.round_trips.clear();
  for (unsigned round = 0; round < rounds; ++round) {
    for (Contestant& one : contestants) {
      for (unsigned i = 0; i < exchanges; ++i) {
        if (!one.exchange(request)) {
          fmt::print(stderr, "handoff_bench: {} has failed\n", one.name);
          return false;
        }
      }
    }
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  unsigned rounds = 600;
  unsigned exchanges = 10;
  for (int i = 1; i < argc; i += 2) {
    const std::string_view option = argv[i];
    const auto count = i + 1 < argc ? static_cast<unsigned>(std::strtoul(argv[i + 1], nullptr, 10)) : 0U;
    if (option == "--rounds" && count > 0) {
      rounds = count;
    } else if (option == "--exchanges" && count > 0) {
      exchanges = count;
    } else {
      fmt::print(stderr, "handoff_bench [--rounds N] [--exchanges N]\n");
      return 2;
    }
  }

  using Doorbells = hardened::Options::Doorbells;
  std::vector<Contestant> contestants;
  contestants.push_back(bare());
  contestants.push_back(hardened_one(1, Doorbells::two));
  contestants.push_back(paper(2, 0ns));
  contestants.push_back(hardened_one(3, Doorbells::one, 0ns));
  contestants.push_back(paper(4, 1ms));
  contestants.push_back(hardened_one(5, Doorbells::one, 1ms));

  bool all_well = true;
  for (Contestant& one : contestants) {
    all_well = all_well && one.master->open().has_value();
  }
  ::usleep(100'000);  // until the slaves serve
  pin(0, 0);
  for (const int core_of_slave : {1, 0}) {
    for (const Contestant& one : contestants) one.echo->stay_on(core_of_slave);
    for (const std::size_t payload_bytes : {std::size_t{64}, std::size_t{512}}) {
      all_well = all_well && measure(contestants, payload_bytes, rounds, exchanges);
      fmt::print("{}, ", core_of_slave == 0 ? "one core" : "two cores");
      if (all_well) print(contestants, payload_bytes);
    }
  }
  for (Contestant& one : contestants) {
    one.echo.reset();
    one.master->close();
    one.remove_objects();
  }
  return all_well ? 0 : 1;
}
