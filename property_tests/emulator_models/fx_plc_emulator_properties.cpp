// The emulator at its programming port against a reference memory: any requests, in any order, get the same answers.

#include <memory>
#include <ostream>

#include <rapidcheck/state.h>

#include "emulator_models/fx_plc_emulator.hpp"
#include "property_tests/emulator_models/fx_reference_memory.hpp"
#include "property_tests/protocol/fx/generated_frames.hpp"
#include "property_tests/support/property.hpp"
#include "sim_clock/explore/quoted_bytes.hpp"

namespace property_tests {
namespace {

using emulator_models::FxPlcEmulator;
using protocol::fx::Command;
using protocol::fx::Model;
using protocol::fx::Request;

/// A PLC, and what it was asked as a session of the fuzz target.
class Session {
 public:
  explicit Session(Model model)
      : plc_{model}, input_{"fx-session", {std::string{protocol::fx::to_string(model)} + '\n'}} {}

  std::string ask(const std::string& message) {
    input_.add(message + '\n');
    const auto answer = plc_.process(bytes_of(message));
    return text_of(protocol::fx::as_span(answer));
  }

 private:
  FxPlcEmulator plc_;
  FuzzInput input_;
};

using FxCommand = rc::state::Command<FxReferenceMemory, Session>;

/// Near a stretch of devices, more often than not at one of its ends.
rc::Gen<std::uint16_t> address_of_interest(Model model, bool wide) {
  return rc::gen::exec([=] {
    const auto ranges = fx_address_ranges(model, wide);
    if (ranges.empty() || *rc::gen::inRange(0, 10) == 0) return *rc::gen::arbitrary<std::uint16_t>();
    const FxAddressRange range = ranges[*rc::gen::inRange<std::size_t>(0, ranges.size())];
    const unsigned from = *rc::gen::element(range.first, range.first, range.end);
    return static_cast<std::uint16_t>(from + *rc::gen::inRange(0U, 12U) - (from == range.end ? 6U : 0U));
  });
}

class Ask : public FxCommand {
 public:
  explicit Ask(const FxReferenceMemory& memory) {
    using enum protocol::fx::Command;
    request_.command = *rc::gen::element(read, read, write, write, force_on, force_off, read_wide, read_wide,
                                         write_wide, force_on_wide, force_off_wide);
    const bool wide = request_.command >= read_wide;
    request_.address = *address_of_interest(memory.model, wide);
    const bool writes = request_.command == write || request_.command == write_wide;
    if (!writes && request_.command != read && request_.command != read_wide) {
      request_.address = static_cast<std::uint16_t>(request_.address * 8U + *rc::gen::inRange(0U, 8U));
      return;
    }
    request_.count_bytes = static_cast<std::uint8_t>(*rc::gen::inRange(1, 20));
    for (unsigned i = 0; writes && i < request_.count_bytes; ++i)
      request_.data.push_back(static_cast<std::byte>(*rc::gen::inRange(0, 256)));
  }

  void apply(FxReferenceMemory& memory) const override { memory.answer(request_); }
  void run(const FxReferenceMemory& before, Session& session) const override {
    FxReferenceMemory memory = before;
    RC_ASSERT(session.ask(bytes()) == memory.answer(request_));
  }
  void show(std::ostream& out) const override { out << "ask " << ltsim::quoted(bytes()); }

 private:
  [[nodiscard]] std::string bytes() const { return text_of(protocol::fx::as_span(encode(request_))); }

  Request request_;
};

/// A frame whose sum is wrong changes nothing, but is noted.
class AskWithBadSum : public FxCommand {
 public:
  AskWithBadSum() : frame_{*any_frame()} {
    char& digit = frame_[frame_.size() - 1 - *rc::gen::inRange<std::size_t>(0, 2)];
    digit = digit == '0' ? 'F' : '0';
  }

  void apply(FxReferenceMemory& memory) const override { memory.refuse(bad_sum); }
  void run(const FxReferenceMemory& /*before*/, Session& session) const override {
    RC_ASSERT(session.ask(frame_) == "\x15");
  }
  void show(std::ostream& out) const override { out << "bad sum " << ltsim::quoted(frame_); }

 private:
  static constexpr unsigned bad_sum = 6203;
  std::string frame_;
};

/// What is no frame at all gets no answer, and ENQ an ACK; neither leaves anything behind.
class SendNoFrame : public FxCommand {
 public:
  SendNoFrame()
      : bytes_{*rc::gen::oneOf(
            rc::gen::just(std::string{"\x05"}),
            rc::gen::suchThat(rc::gen::arbitrary<std::string>(), [](const std::string& text) {
              return text != "\x05" && !text.starts_with('\x02') && text.find('\n') == std::string::npos;
            }))} {}

  void run(const FxReferenceMemory& /*before*/, Session& session) const override {
    RC_ASSERT(session.ask(bytes_) == (bytes_ == "\x05" ? "\x06" : ""));
  }
  void show(std::ostream& out) const override { out << "no frame " << ltsim::quoted(bytes_); }

 private:
  std::string bytes_;
};

PROPERTY(FxPlcEmulator, answers_any_session_as_the_tables_say, ()) {
  const Model model = *rc::gen::element(Model::fx1s, Model::fx1n, Model::fx2n, Model::fx3u);
  Session session{model};
  rc::state::check(FxReferenceMemory{model}, session,
                   rc::state::gen::execOneOfWithArgs<Ask, Ask, Ask, AskWithBadSum, SendNoFrame>());
}

PROPERTY(FxPlcEmulator, shows_what_was_written_and_nothing_beside_it, ()) {
  const Model model = *rc::gen::element(Model::fx1s, Model::fx1n, Model::fx2n, Model::fx3u);
  const auto writes = *rc::gen::container<std::vector<Request>>(rc::gen::exec([model] {
    const bool wide = *rc::gen::arbitrary<bool>();
    Request request;
    request.command = wide ? Command::write_wide : Command::write;
    request.address = *address_of_interest(model, wide);
    request.count_bytes = static_cast<std::uint8_t>(*rc::gen::inRange(1, 6));
    for (unsigned i = 0; i < request.count_bytes; ++i)
      request.data.push_back(static_cast<std::byte>(*rc::gen::inRange(0, 256)));
    return request;
  }));
  Session session{model};
  FxReferenceMemory memory{model};
  for (const Request& request : writes)
    RC_ASSERT(session.ask(text_of(protocol::fx::as_span(encode(request)))) == memory.answer(request));
  for (const bool wide : {false, true}) {
    for (const FxAddressRange range : fx_address_ranges(model, wide)) {
      for (unsigned address = range.first; address < std::min(range.end, range.first + 24U); ++address) {
        const Request read{
            wide ? Command::read_wide : Command::read, static_cast<std::uint16_t>(address), 1, {}};
        RC_ASSERT(session.ask(text_of(protocol::fx::as_span(encode(read)))) == memory.answer(read));
      }
    }
  }
}

}  // namespace
}  // namespace property_tests
