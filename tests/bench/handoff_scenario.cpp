// The smallest handoff that uses what every handoff uses, unmodified: a Boost.Interprocess segment, mapped by
// two processes at different addresses, and two named semaphores.

#include <atomic>
#include <cstdint>

#include <boost/interprocess/mapped_region.hpp>
#include <boost/interprocess/shared_memory_object.hpp>
#include <boost/interprocess/sync/named_semaphore.hpp>

#include "sim_clock/scenario/scenario.hpp"

namespace {

namespace ipc = boost::interprocess;

struct Mailbox {
  std::atomic<std::uint32_t> request;
  std::atomic<std::uint32_t> answer;
};

/// One side's view of the named objects.
class Handoff {
 public:
  Handoff()
      : segment_(ipc::open_or_create, "handoff", ipc::read_write),
        requested_(ipc::open_or_create, "requested", 0),
        answered_(ipc::open_or_create, "answered", 0) {
    segment_.truncate(sizeof(Mailbox));
    memory_ = ipc::mapped_region(segment_, ipc::read_write);
  }

  [[nodiscard]] std::uint32_t call(std::uint32_t request) {
    mailbox().request.store(request, std::memory_order_relaxed);  // the semaphores order everything
    requested_.post();
    answered_.wait();
    return mailbox().answer.load(std::memory_order_relaxed);
  }

  void serve() {
    requested_.wait();
    mailbox().answer.store(mailbox().request.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    answered_.post();
  }

 private:
  [[nodiscard]] Mailbox& mailbox() noexcept { return *static_cast<Mailbox*>(memory_.get_address()); }

  ipc::shared_memory_object segment_;
  ipc::named_semaphore requested_;
  ipc::named_semaphore answered_;
  ipc::mapped_region memory_;
};

}  // namespace

SCENARIO("bench/handoff", "one request and its answer over a segment and two semaphores") {
  std::uint32_t answer = 0;
  world.process("kernel").start("main", [&] { answer = Handoff{}.call(7); });
  world.process("emulator").start("main", [] { Handoff{}.serve(); });
  world.run();
  world.require(answer == 8, "the answer belongs to the request");
}

SCENARIO("bench/hundred-handoffs", "a hundred requests and their answers, one after the other") {
  constexpr std::uint32_t requests_count = 100;
  std::uint32_t answered_count = 0;
  world.process("kernel").start("main", [&] {
    Handoff handoff;
    for (std::uint32_t i = 0; i < requests_count; ++i) answered_count += handoff.call(i) == i + 1 ? 1 : 0;
  });
  world.process("emulator").start("main", [] {
    Handoff handoff;
    for (std::uint32_t i = 0; i < requests_count; ++i) handoff.serve();
  });
  world.run();
  world.require(answered_count == requests_count, "each answer belongs to its request");
}
