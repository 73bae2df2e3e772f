#include "tests/scenarios/litmus/small_program.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace litmus {
namespace {

constexpr std::array<std::pair<std::string_view, std::memory_order>, 5> orders{{
    {"rlx", std::memory_order_relaxed},
    {"acq", std::memory_order_acquire},
    {"rel", std::memory_order_release},
    {"ar", std::memory_order_acq_rel},
    {"sc", std::memory_order_seq_cst},
}};
constexpr std::string_view names = "xyz";

std::memory_order parse_order(std::string_view name, std::string_view step) {
  for (const auto& [known, order] : orders) {
    if (known == name) return order;
  }
  throw std::invalid_argument{fmt::format("\"{}\": no memory order is called \"{}\"", step, name)};
}

std::string_view name_of(std::memory_order order) noexcept {
  for (const auto& [name, known] : orders) {
    if (known == order) return name;
  }
  return "?";
}

std::uint32_t parse_value(std::string_view text, std::string_view step) {
  if (text.size() != 1 || text[0] < '0' || text[0] > '9')
    throw std::invalid_argument{fmt::format("\"{}\": \"{}\" is no digit", step, text)};
  return static_cast<std::uint32_t>(text[0] - '0');
}

Step parse_step(std::string_view text) {
  const std::size_t dot = text.rfind('.');
  if (dot == std::string_view::npos)
    throw std::invalid_argument{fmt::format("\"{}\" is no step: its memory order is missing", text)};
  Step step;
  step.order = parse_order(text.substr(dot + 1), text);
  const std::string_view what = text.substr(0, dot);
  if (what == "fence") {
    step.kind = Step::Kind::fence;
    return step;
  }
  const std::size_t word = what.empty() ? std::string_view::npos : names.find(what[0]);
  if (word == std::string_view::npos)
    throw std::invalid_argument{fmt::format("\"{}\" is no step: it begins with no word", text)};
  step.word = word;
  const std::string_view rest = what.substr(1);
  if (rest.starts_with("+=")) {
    step.kind = Step::Kind::add;
    step.value = parse_value(rest.substr(2), text);
  } else if (rest.starts_with("=")) {
    step.kind = Step::Kind::store;
    step.value = parse_value(rest.substr(1), text);
  } else if (rest.size() == 4 && rest[0] == '?' && rest[2] == ':') {
    step.kind = Step::Kind::compare;
    step.expected = parse_value(rest.substr(1, 1), text);
    step.value = parse_value(rest.substr(3), text);
  } else if (!rest.empty()) {
    throw std::invalid_argument{fmt::format("\"{}\" is no step", text)};
  }
  return step;
}

std::string to_string(const Step& step) {
  const std::string_view order = name_of(step.order);
  const char word = names[step.word];
  switch (step.kind) {
    case Step::Kind::load:
      return fmt::format("{}.{}", word, order);
    case Step::Kind::store:
      return fmt::format("{}={}.{}", word, step.value, order);
    case Step::Kind::add:
      return fmt::format("{}+={}.{}", word, step.value, order);
    case Step::Kind::compare:
      return fmt::format("{}?{}:{}.{}", word, step.expected, step.value, order);
    case Step::Kind::fence:
      return fmt::format("fence.{}", order);
  }
  return "?";
}

using Word = std::atomic<std::uint32_t>;

// The compiler must see constants: it takes an order that it does not know for seq_cst.

std::uint32_t load(const Word& word, std::memory_order order) {
  if (order == std::memory_order_relaxed) return word.load(std::memory_order_relaxed);
  if (order == std::memory_order_acquire) return word.load(std::memory_order_acquire);
  return word.load(std::memory_order_seq_cst);
}

void store(Word& word, std::uint32_t value, std::memory_order order) {
  if (order == std::memory_order_relaxed) {
    word.store(value, std::memory_order_relaxed);
  } else if (order == std::memory_order_release) {
    word.store(value, std::memory_order_release);
  } else {
    word.store(value, std::memory_order_seq_cst);
  }
}

std::uint32_t add(Word& word, std::uint32_t value, std::memory_order order) {
  switch (order) {
    case std::memory_order_relaxed:
      return word.fetch_add(value, std::memory_order_relaxed);
    case std::memory_order_acquire:
      return word.fetch_add(value, std::memory_order_acquire);
    case std::memory_order_release:
      return word.fetch_add(value, std::memory_order_release);
    case std::memory_order_acq_rel:
      return word.fetch_add(value, std::memory_order_acq_rel);
    default:
      return word.fetch_add(value, std::memory_order_seq_cst);
  }
}

std::uint32_t compare(Word& word, std::uint32_t found, std::uint32_t value, std::memory_order order) {
  switch (order) {
    case std::memory_order_relaxed:
      word.compare_exchange_strong(found, value, std::memory_order_relaxed);
      break;
    case std::memory_order_acquire:
      word.compare_exchange_strong(found, value, std::memory_order_acquire);
      break;
    case std::memory_order_release:
      word.compare_exchange_strong(found, value, std::memory_order_release);
      break;
    case std::memory_order_acq_rel:
      word.compare_exchange_strong(found, value, std::memory_order_acq_rel);
      break;
    default:
      word.compare_exchange_strong(found, value, std::memory_order_seq_cst);
  }
  return found;
}

void fence(std::memory_order order) {
  switch (order) {
    case std::memory_order_acquire:
      std::atomic_thread_fence(std::memory_order_acquire);
      break;
    case std::memory_order_release:
      std::atomic_thread_fence(std::memory_order_release);
      break;
    case std::memory_order_acq_rel:
      std::atomic_thread_fence(std::memory_order_acq_rel);
      break;
    case std::memory_order_seq_cst:
      std::atomic_thread_fence(std::memory_order_seq_cst);
      break;
    default:
      break;
  }
}

}  // namespace

std::memory_order order_when_failing(std::memory_order order) noexcept {
  if (order == std::memory_order_acq_rel) return std::memory_order_acquire;
  return order == std::memory_order_release ? std::memory_order_relaxed : order;
}

std::size_t reads_count(const Task& task) noexcept {
  return static_cast<std::size_t>(
      std::count_if(task.begin(), task.end(), [](const Step& step) { return reads(step.kind); }));
}

Program parse(std::string_view text) {
  Program program(1);
  std::istringstream words{std::string{text}};
  for (std::string word; words >> word;) {
    if (word == "||") {
      program.emplace_back();
    } else if (word != ";") {
      program.back().push_back(parse_step(word));
    }
  }
  return program;
}

std::string to_string(const Program& program) {
  std::string text;
  for (const Task& task : program) {
    if (&task != &program.front()) text += " || ";
    for (std::size_t i = 0; i < task.size(); ++i) text += (i == 0 ? "" : " ; ") + to_string(task[i]);
  }
  return text;
}

std::string to_string(const Result& result) {
  return fmt::format("{} | {}", fmt::join(result.read, " "), fmt::join(result.words, " "));
}

bool matches(const Result& result, std::string_view pattern) {
  std::istringstream parts{std::string{pattern}};
  bool in_words = false;
  std::size_t at = 0;
  for (std::string part; parts >> part;) {
    if (part == "|") {
      in_words = true;
      at = 0;
      continue;
    }
    const std::size_t size = in_words ? result.words.size() : result.read.size();
    if (at == size) throw std::invalid_argument{fmt::format("\"{}\": too many numbers", pattern)};
    const std::uint32_t value = in_words ? result.words[at] : result.read[at];
    ++at;
    if (part != "*" && part != std::to_string(value)) return false;
  }
  return true;
}

void run(const Task& task, Words& words, std::uint32_t* read) {
  for (const Step& step : task) {
    Word& word = words[step.word];
    switch (step.kind) {
      case Step::Kind::load:
        *read++ = load(word, step.order);
        break;
      case Step::Kind::store:
        store(word, step.value, step.order);
        break;
      case Step::Kind::add:
        *read++ = add(word, step.value, step.order);
        break;
      case Step::Kind::compare:
        *read++ = compare(word, step.expected, step.value, step.order);
        break;
      case Step::Kind::fence:
        fence(step.order);
        break;
    }
  }
}

}  // namespace litmus
