#include "tests/sim_clock/known_traces.hpp"

#include <semaphore.h>

#include <array>
#include <atomic>
#include <mutex>

#include <fmt/format.h>

namespace ltsim {
namespace {

using Word = std::atomic<std::uint32_t>;

Known writers(std::uint32_t n) {
  return {fmt::format("writers_{}", n), factorial(n), [n](World& world) {
            Word word{0};
            start_tasks(world, n, [&](std::uint32_t i) { word.store(i); });
            world.run();
          }};
}

/// Each reader comes before the writer or after it.
Known readers(std::uint32_t n) {
  return {fmt::format("readers_{}", n), std::uint64_t{1} << n, [n](World& world) {
            Word word{0};
            world.process("program").start("writer", [&] { word.store(1); });
            start_tasks(world, n, [&](std::uint32_t) { static_cast<void>(word.load()); });
            world.run();
          }};
}

/// Two tasks with n updates of one word each.
Known two_counters(std::uint32_t n) {
  return {fmt::format("two_counters_{}", n), choose(2 * n, n), [n](World& world) {
            Word word{0};
            start_tasks(world, 2, [&](std::uint32_t) {
              for (std::uint32_t i = 0; i < n; ++i) word.fetch_add(1);
            });
            world.run();
          }};
}

Known three_counters(std::uint32_t n) {
  return {fmt::format("three_counters_{}", n),
          factorial(3 * n) / (factorial(n) * factorial(n) * factorial(n)), [n](World& world) {
            Word word{0};
            start_tasks(world, 3, [&](std::uint32_t) {
              for (std::uint32_t i = 0; i < n; ++i) word.fetch_add(1);
            });
            world.run();
          }};
}

Known own_words(std::uint32_t n) {
  return {fmt::format("own_words_{}", n), 1, [n](World& world) {
            std::array<Word, 8> words{};
            start_tasks(world, n, [&](std::uint32_t i) { words[i].store(words[i].load() + 1); });
            world.run();
          }};
}

/// "Indexer" of Flanagan and Godefroid: each task puts four numbers into a hash table of 128 places; up to 11 tasks never meet, and
/// each further one meets three others.
Known indexer(std::uint32_t n) {
  return {fmt::format("indexer_{}", n), std::uint64_t{1} << (3 * (n - 11)), [n](World& world) {
            std::array<Word, 128> table{};
            start_tasks(world, n, [&](std::uint32_t task) {
              for (std::uint32_t i = 1; i <= 4; ++i) {
                const std::uint32_t message = i * 11 + task;
                std::uint32_t hash = message * 7 % 128;
                std::uint32_t empty = 0;
                while (!table[hash].compare_exchange_strong(empty, message)) {
                  hash = (hash + 1) % 128;
                  empty = 0;
                }
              }
            });
            world.run();
          }};
}

/// The first exchange decides; those that fail only look.
Known one_winner(std::uint32_t n) {
  return {fmt::format("one_winner_{}", n), n, [n](World& world) {
            Word word{0};
            start_tasks(world, n, [&](std::uint32_t i) {
              std::uint32_t nobody = 0;
              word.compare_exchange_strong(nobody, i + 1);
            });
            world.run();
          }};
}

Known one_mutex(std::uint32_t n) {
  return {fmt::format("one_mutex_{}", n), factorial(n), [n](World& world) {
            std::mutex mutex;
            std::uint32_t count = 0;
            start_tasks(world, n, [&](std::uint32_t) {
              const std::lock_guard lock{mutex};
              ++count;
            });
            world.run();
            world.require(count == n, "a count is lost");
          }};
}

/// Posts and waits of one semaphore, so that no wait comes before its post: the n-th Catalan number.
Known tokens(std::uint32_t n) {
  return {fmt::format("tokens_{}", n), choose(2 * n, n) / (n + 1), [n](World& world) {
            world.leave_semaphore("tokens", 0);
            start_tasks(world, 2, [&](std::uint32_t i) {
              sem_t* const tokens = sem_open("tokens", 0);
              for (std::uint32_t k = 0; k < n; ++k) i == 0 ? sem_post(tokens) : sem_wait(tokens);
            });
            world.run();
          }};
}

/// Of the four orders of the two pairs one is a circle.
Known store_buffering() {
  return {"store_buffering", 3, [](World& world) {
            std::array<Word, 2> words{};
            start_tasks(world, 2, [&](std::uint32_t i) {
              words[i].store(1);
              static_cast<void>(words[1 - i].load());
            });
            world.run();
          }};
}

}  // namespace

std::uint64_t factorial(std::uint64_t n) { return n < 2 ? 1 : n * factorial(n - 1); }
std::uint64_t choose(std::uint64_t n, std::uint64_t k) {
  return factorial(n) / (factorial(k) * factorial(n - k));
}

void start_tasks(World& world, std::uint32_t count, const std::function<void(std::uint32_t)>& body) {
  for (std::uint32_t i = 0; i < count; ++i)
    world.process("program").start(fmt::format("task-{}", i), [body, i] { body(i); });
}

/// "Last zero" of Abdulla and others: one task looks for the last word that is 0, from the end; the others each make their word
/// one more than the one before it.
Known last_zero(std::uint32_t n) {
  return {fmt::format("last_zero_{}", n), (n + 1) * (std::uint64_t{1} << (n - 1)), [n](World& world) {
            std::array<Word, 16> words{};
            world.process("program").start("reader", [&] {
              for (std::uint32_t i = n; i > 0 && words[i].load() == 0;) --i;
            });
            start_tasks(world, n, [&](std::uint32_t i) { words[i + 1].store(words[i].load() + 1); });
            world.run();
          }};
}

std::vector<Known> known_programs() {
  return {writers(2),      writers(6),        readers(1),   readers(8),   two_counters(1),
          two_counters(5), three_counters(2), own_words(6), last_zero(1), last_zero(5),
          last_zero(9),    indexer(11),       indexer(13),  indexer(15),  one_winner(5),
          one_mutex(2),    one_mutex(6),      tokens(1),    tokens(5),    store_buffering()};
}

}  // namespace ltsim
