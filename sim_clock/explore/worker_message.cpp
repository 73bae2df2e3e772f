#include "sim_clock/explore/worker_message.hpp"

#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace ltsim {
namespace {

using nlohmann::json;

/// Text of the code under test, which need not be UTF-8.
json as_bytes(const std::string& text) { return json::binary({text.begin(), text.end()}); }

std::string text_of(const json& bytes) {
  const auto& binary = bytes.get_binary();
  return {binary.begin(), binary.end()};
}

json to_json(const WorkerFoundFailure& found) {
  const Failure& failure = found.failure;
  json messages = json::array();
  for (const std::string& message : failure.messages) messages.push_back(as_bytes(message));
  return {{"type", "failure"},
          {"place", found.place},
          {"kind", failure.outcome.kind},
          {"message", as_bytes(failure.outcome.message)},
          {"execution", failure.execution},
          {"seed", failure.seed},
          {"hash", failure.trace_hash},
          {"at", failure.at.count()},
          {"schedule", as_bytes(to_string(failure.schedule))},
          {"choices", failure.choices_count},
          {"one minimal", failure.one_minimal},
          {"story", as_bytes(failure.story)},
          {"output", as_bytes(failure.output)},
          {"messages", std::move(messages)}};
}

json to_json(const WorkerGaveUp& gave_up) {
  return {{"type", "gave up"}, {"execution", gave_up.execution}, {"message", as_bytes(gave_up.message)}};
}

json to_json(const WorkerFinished&) { return {{"type", "finished"}}; }

WorkerFoundFailure found_failure_of(const json& object) {
  auto schedule = parse_schedule(text_of(object.at("schedule")));
  if (!schedule) throw std::runtime_error{fmt::format("schedule of a worker: {}", schedule.error().reason)};
  for (Deviation& deviation : schedule->deviations) deviation.line = 0;  // it came from no file
  Failure failure;
  failure.outcome = {.kind = object.at("kind").get<OutcomeKind>(), .message = text_of(object.at("message"))};
  failure.execution = object.at("execution").get<std::uint64_t>();
  failure.seed = object.at("seed").get<std::uint64_t>();
  failure.trace_hash = object.at("hash").get<std::uint64_t>();
  failure.at = SimTime{object.at("at").get<SimTime::rep>()};
  failure.schedule = std::move(*schedule);
  failure.choices_count = object.at("choices").get<std::size_t>();
  failure.one_minimal = object.at("one minimal").get<bool>();
  failure.story = text_of(object.at("story"));
  failure.output = text_of(object.at("output"));
  for (const json& message : object.at("messages")) failure.messages.push_back(text_of(message));
  return {.place = object.at("place").get<std::size_t>(), .failure = std::move(failure)};
}

WorkerMessage message_of(const json& object) {
  const auto& type = object.at("type").get_ref<const std::string&>();
  if (type == "failure") return found_failure_of(object);
  if (type == "gave up") {
    return WorkerGaveUp{.execution = object.at("execution").get<std::uint64_t>(),
                        .message = text_of(object.at("message"))};
  }
  return WorkerFinished{};
}

}  // namespace

std::vector<std::uint8_t> encode(const WorkerMessage& message) {
  return as_frame(json::to_cbor(std::visit([](const auto& each) { return to_json(each); }, message)));
}

std::optional<WorkerMessage> WorkerMessageReader::next() {
  const auto frame = frames_.next();
  if (!frame) return std::nullopt;
  return message_of(json::from_cbor(*frame));
}

}  // namespace ltsim
