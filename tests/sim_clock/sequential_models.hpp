// Sequential models for tests of histories: what the textbooks use.
#pragma once

#include <compare>
#include <deque>
#include <optional>
#include <string>

namespace ltsim {

struct RegisterModel {
  using State = int;
  struct Operation {
    bool writes = false;
    int value = 0;  // of a write
    int key = 0;    // for the model of many registers
  };
  using Result = int;  // of a read; a write answers with the value written

  static State initial() { return 0; }
  static std::optional<State> step(const State& state, const Operation& operation, const Result* result) {
    const int next = operation.writes ? operation.value : state;
    return result == nullptr || *result == next ? std::optional{next} : std::nullopt;
  }
  static std::string operation_text(const Operation& operation) {
    return operation.writes ? "write " + std::to_string(operation.value) : "read";
  }
  static std::string result_text(const Result& result) { return std::to_string(result); }

  static Operation read(int key = 0) { return {.writes = false, .value = 0, .key = key}; }
  static Operation write(int value, int key = 0) { return {.writes = true, .value = value, .key = key}; }
};

/// Registers that know nothing of each other.
struct RegistersModel : RegisterModel {
  static int partition(const Operation& operation) { return operation.key; }
};

struct CounterModel {
  using State = int;
  struct Operation {
    int added = 0;
  };
  using Result = int;  // the sum after it

  static State initial() { return 0; }
  static std::optional<State> step(const State& state, const Operation& operation, const Result* result) {
    const int next = state + operation.added;
    return result == nullptr || *result == next ? std::optional{next} : std::nullopt;
  }
  static std::string operation_text(const Operation& operation) {
    return "add " + std::to_string(operation.added);
  }
  static std::string result_text(const Result& result) { return std::to_string(result); }
};

struct QueueModel {
  using State = std::deque<char>;
  struct Operation {
    char enqueued = 0;  // 0: it dequeues
  };
  using Result = char;  // what was dequeued; 0 of an enqueue

  static State initial() { return {}; }
  static std::optional<State> step(const State& state, const Operation& operation, const Result* result) {
    State next = state;
    if (operation.enqueued != 0) {
      next.push_back(operation.enqueued);
      return next;
    }
    if (state.empty() || (result != nullptr && *result != state.front())) return std::nullopt;
    next.pop_front();
    return next;
  }
  static std::string operation_text(const Operation& operation) {
    return operation.enqueued != 0 ? std::string{"enqueue "} + operation.enqueued : std::string{"dequeue"};
  }
  static std::string result_text(const Result& result) {
    return result == 0 ? std::string{"ok"} : std::string{result};
  }

  static Operation dequeue() { return {}; }
  static Operation enqueue(char item) { return {.enqueued = item}; }
};

}  // namespace ltsim
