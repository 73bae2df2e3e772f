#include "sim_clock/explore/schedule.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include <fmt/format.h>

#include "sim_clock/explore/duration_text.hpp"
#include "sim_clock/explore/quoted_bytes.hpp"

namespace ltsim {
namespace {

/// What separates words, and is no part of a line at its ends: a carriage return is one, wherever it stands.
constexpr std::string_view blanks = " \t\r";

std::string_view without_blanks_around(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

/// Words are separated by any number of blanks.
std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t begin = line.find_first_not_of(blanks, at);
    if (begin == std::string_view::npos) break;
    const std::size_t end = std::min(line.find_first_of(blanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    at = end;
  }
  return words;
}

std::string_view rest_after_first_word(std::string_view line) {
  return without_blanks_around(line.substr(std::min(line.find_first_of(blanks), line.size())));
}

std::string join(const std::vector<std::string_view>& words, std::size_t begin, std::size_t end) {
  std::string text;
  for (std::size_t i = begin; i < end; ++i) {
    if (i != begin) text += ' ';
    text += words[i];
  }
  return text;
}

/// "task phase operation object #n", "task asks what #n", "task end" or "- start".
bool is_anchor(const std::vector<std::string_view>& words, std::size_t begin, std::size_t end) {
  if (end - begin < 2) return false;
  const std::string_view phase = words[begin + 1];
  if (phase == "end" || phase == "start") return end - begin == 2;
  const std::size_t count = phase == "before" || phase == "in" ? 5U : phase == "asks" ? 4U : 0U;
  const std::string_view occurrence = words[end - 1];
  return end - begin == count && occurrence.size() > 1 && occurrence.front() == '#' &&
         occurrence.find_first_not_of("0123456789", 1) == std::string_view::npos;
}

std::optional<OutcomeKind> parse_outcome_kind(std::string_view text) {
  for (auto kind = OutcomeKind::passed; kind <= OutcomeKind::unsupported;
       kind = static_cast<OutcomeKind>(static_cast<int>(kind) + 1)) {
    if (to_string(kind) == text) return kind;
  }
  return std::nullopt;
}

std::optional<FaultKind> parse_fault_kind(std::string_view text) {
  for (std::size_t i = 0; i < fault_kinds_count; ++i) {
    if (to_string(static_cast<FaultKind>(i)) == text) return static_cast<FaultKind>(i);
  }
  return std::nullopt;
}

std::optional<std::size_t> parse_number(std::string_view text) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

tl::expected<Deviation, std::string> parse_deviation(const std::vector<std::string_view>& words) {
  const std::string_view kind = words.front();
  Deviation deviation;
  std::size_t anchor_end = words.size() - 1;
  if (kind == "switch") {
    anchor_end = words.size() < 2 ? 0 : words.size() - 2;
    if (anchor_end == 0 || words[anchor_end] != "to") {
      return tl::unexpected<std::string>("a switch line is: switch TASK before OPERATION OBJECT #N to TASK");
    }
    deviation.to_task = words.back();
  } else if (kind == "time" || kind == "stall") {
    deviation.kind = kind == "time" ? Deviation::Kind::pass_time : Deviation::Kind::stall;
    const std::string_view duration = words.back();
    const auto passes = duration.starts_with('+') ? parse_duration(duration.substr(1)) : std::nullopt;
    if (!passes)
      return tl::unexpected<std::string>(
          "a time or stall line ends with a duration such as +20ms (ns, us, ms or s)");
    deviation.passes = *passes;
  } else if (kind == "fault") {
    deviation.kind = Deviation::Kind::fault;
    anchor_end = words.size() < 3 ? 0 : words.size() - 2;
    const auto fault = anchor_end == 0 ? std::nullopt : parse_fault_kind(words[anchor_end]);
    const auto variant = parse_number(words.back());
    if (!fault || *fault == FaultKind::crash || !variant || *variant == 0) {
      return tl::unexpected<std::string>(
          "a fault line ends with the kind of fault and the number, from 1, of the way in which it strikes");
    }
    deviation.fault = *fault;
    deviation.answer = *variant;
  } else if (kind == "crash") {
    deviation.kind = Deviation::Kind::fault;
    anchor_end = words.size() < 2 ? 0 : words.size() - 2;
    if (anchor_end == 0 || words[anchor_end] != "of") {
      return tl::unexpected<std::string>("a crash line is: crash TASK before OPERATION OBJECT #N of PROCESS");
    }
    deviation.process = words.back();
  } else if (kind == "older") {
    deviation.kind = Deviation::Kind::older;
    anchor_end = words.size() < 2 ? 0 : words.size() - 2;
    const auto age = parse_number(words.back());
    if (anchor_end == 0 || words[anchor_end] != "by" || !age || *age == 0) {
      return tl::unexpected<std::string>(
          "an older line is: older TASK before OPERATION OBJECT #N by COUNT, the count of newer stores, from "
          "1");
    }
    deviation.answer = *age;
  } else {
    deviation.kind = Deviation::Kind::choose;
    const auto answer = parse_number(words.back());
    if (!answer) return tl::unexpected<std::string>("a choose line ends with the number that was answered");
    deviation.answer = *answer;
  }
  if (!is_anchor(words, 1, anchor_end)) {
    return tl::unexpected<std::string>(
        "the place must be \"TASK before OPERATION OBJECT #N\", \"TASK in OPERATION OBJECT #N\", \"TASK asks "
        "WHAT #N\", \"TASK end\" "
        "or \"- start\"");
  }
  deviation.anchor = join(words, 1, anchor_end);
  return deviation;
}

}  // namespace

std::string to_string(const Deviation& deviation) {
  const std::size_t blank = deviation.anchor.find(' ');
  const std::string place =
      fmt::format("{:<16} {:<44}", deviation.anchor.substr(0, blank), deviation.anchor.substr(blank + 1));
  switch (deviation.kind) {
    case Deviation::Kind::switch_task:
      return fmt::format("switch    {} to {}", place, deviation.to_task);
    case Deviation::Kind::pass_time:
      return fmt::format("time      {} +{}", place, to_text(deviation.passes));
    case Deviation::Kind::stall:
      return fmt::format("stall     {} +{}", place, to_text(deviation.passes));
    case Deviation::Kind::fault:
      if (deviation.fault == FaultKind::crash)
        return fmt::format("crash     {} of {}", place, deviation.process);
      return fmt::format("fault     {} {} {}", place, to_string(deviation.fault), deviation.answer);
    case Deviation::Kind::choose:
      return fmt::format("choose    {} {}", place, deviation.answer);
    case Deviation::Kind::older:
      return fmt::format("older     {} by {}", place, deviation.answer);
  }
  return {};
}

std::vector<std::string> input_lines(const Schedule& schedule) {
  std::vector<std::string> lines;
  for (const std::string& record : schedule.input)
    lines.push_back(fmt::format("input     {}", quoted(record)));
  return lines;
}

std::string one_line(std::string message) {
  std::replace_if(message.begin(), message.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  // Blanks around it would be taken for those of the line.
  return std::string{without_blanks_around(message)};
}

std::string to_string(const Schedule& schedule) {
  const std::string message = one_line(schedule.message);
  std::string text = fmt::format(
      "{}\nscenario  {}\nmemory    {}\n{}{}{}{}outcome   {}{}{}\n", schedule_header, schedule.scenario,
      to_string(schedule.memory), schedule.cpu == Cpu::many ? "" : "cpu       one-fifo\n",
      schedule.findings.races ? "" : "races     off\n", schedule.findings.leaks ? "" : "leaks     off\n",
      schedule.start_state == StartState::restore ? "" : "state     fork\n", to_string(schedule.outcome),
      message.empty() ? "" : ": ", message);
  for (std::size_t i = 0; i < schedule.program.size(); ++i)
    text += fmt::format("{}{}\n", i == 0 ? "program   " : "argument  ", quoted(schedule.program[i]));
  for (const std::string& line : input_lines(schedule)) text += line + "\n";
  for (const Deviation& deviation : schedule.deviations) text += to_string(deviation) + "\n";
  return text;
}

tl::expected<Schedule, ScheduleError> parse_schedule(std::string_view text) {
  Schedule schedule;
  bool header_seen = false;
  std::size_t number = 0;
  const auto error = [&number](std::string reason) {
    return tl::unexpected(ScheduleError{.line = number, .reason = std::move(reason)});
  };
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = without_blanks_around(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    const auto words = words_of(line);
    if (words.empty() || words.front().starts_with('#')) continue;
    if (!header_seen) {
      if (join(words, 0, words.size()) != schedule_header)
        return error(fmt::format("a schedule begins with \"{}\"", schedule_header));
      header_seen = true;
    } else if (words.front() == "scenario") {
      if (words.size() != 2) return error("a scenario line names one scenario");
      schedule.scenario = words[1];
    } else if (words.front() == "memory") {
      const bool known =
          words.size() == 2 && (words[1] == to_string(Memory::sc) || words[1] == to_string(Memory::c11));
      if (!known) return error("a memory line says \"sc\" or \"c11\"");
      schedule.memory = words[1] == to_string(Memory::sc) ? Memory::sc : Memory::c11;
    } else if (words.front() == "cpu") {
      const bool known =
          words.size() == 2 && (words[1] == to_string(Cpu::many) || words[1] == to_string(Cpu::one_fifo));
      if (!known) return error("a cpu line says \"many\" or \"one-fifo\"");
      schedule.cpu = words[1] == to_string(Cpu::many) ? Cpu::many : Cpu::one_fifo;
    } else if (words.front() == "races" || words.front() == "leaks") {
      if (words.size() != 2 || (words[1] != "on" && words[1] != "off"))
        return error(fmt::format("a {} line says \"on\" or \"off\"", words.front()));
      (words.front() == "races" ? schedule.findings.races : schedule.findings.leaks) = words[1] == "on";
    } else if (words.front() == "state") {
      const bool known = words.size() == 2 && (words[1] == to_string(StartState::restore) ||
                                               words[1] == to_string(StartState::fork));
      if (!known) return error("a state line says \"restore\" or \"fork\"");
      schedule.start_state =
          words[1] == to_string(StartState::restore) ? StartState::restore : StartState::fork;
    } else if (words.front() == "outcome") {
      const std::string_view rest = rest_after_first_word(line);
      const std::size_t colon = std::min(rest.find(':'), rest.size());
      const auto kind = parse_outcome_kind(rest.substr(0, colon));
      if (!kind) return error(fmt::format("no outcome is called \"{}\"", rest.substr(0, colon)));
      schedule.outcome = *kind;
      schedule.message = one_line(std::string{rest.substr(std::min(colon + 1, rest.size()))});
    } else if (words.front() == "program" || words.front() == "argument") {
      if ((words.front() == "program") != schedule.program.empty())
        return error("one program line, and the argument lines after it");
      auto word = parse_quoted(rest_after_first_word(line));
      if (!word) return error(std::move(word.error()));
      schedule.program.push_back(std::move(*word));
    } else if (words.front() == "input") {
      auto record = parse_quoted(rest_after_first_word(line));
      if (!record) return error(std::move(record.error()));
      schedule.input.push_back(std::move(*record));
    } else if (words.front() == "switch" || words.front() == "time" || words.front() == "stall" ||
               words.front() == "fault" || words.front() == "crash" || words.front() == "choose" ||
               words.front() == "older") {
      auto deviation = parse_deviation(words);
      if (!deviation) return error(std::move(deviation.error()));
      deviation->line = number;
      schedule.deviations.push_back(std::move(*deviation));
    } else {
      return error(
          fmt::format("\"{}\" begins no line of a schedule; known are scenario, memory, cpu, races, leaks, "
                      "state, outcome, "
                      "program, argument, input, switch, "
                      "time, stall, fault, crash, choose, older",
                      words.front()));
    }
  }
  number = number == 0 ? 1 : number;
  if (!header_seen)
    return error(fmt::format("the file is empty; a schedule begins with \"{}\"", schedule_header));
  if (schedule.scenario.empty()) return error("no line says which scenario this is a schedule of");
  return schedule;
}

}  // namespace ltsim
