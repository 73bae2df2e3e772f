#include "emulator_models/configuration_service.hpp"

#include <algorithm>
#include <utility>

namespace emulator_models {
namespace {

using soft_plc::ConfigurationTransfer;

/// @return the part of the reason that fits, from `offset` on
TransferAnswer refusal_of(const TransferRequest& request, std::string_view reason, std::size_t offset = 0) {
  TransferAnswer answer{.taken = false, .command = request.command, .number = request.number, .text = {}};
  const std::string_view part =
      reason.substr(std::min(offset, reason.size())).substr(0, reason_part_bytes_max);
  for (const char character : part) answer.text.push_back(static_cast<std::byte>(character));
  return answer;
}

std::string bounded(std::string reason) {
  if (reason.size() <= ConfigurationService::reason_bytes_max) return reason;
  reason.resize(ConfigurationService::reason_bytes_max - ConfigurationService::cut_mark.size());
  return reason += ConfigurationService::cut_mark;
}

}  // namespace

TransferAnswer ConfigurationService::answer(const TransferRequest& request) {
  if (request.command == TransferCommand::reason) {
    const std::lock_guard lock{mutex_};
    return refusal_of(request, request.second == refused_sum_ ? reason_ : std::string{}, request.number);
  }
  const auto done = serve(request);
  const std::string reason = done ? std::string{} : bounded(done.error());
  if (request.command == TransferCommand::commit) {
    const std::lock_guard lock{mutex_};
    refused_sum_ = request.number;
    reason_ = reason;
  }
  if (!done) return refusal_of(request, reason);
  return {.taken = true, .command = request.command, .number = request.number, .text = {}};
}

tl::expected<void, std::string> ConfigurationService::serve(const TransferRequest& request) {
  switch (request.command) {
    case TransferCommand::begin:
      return transfer_.serve(ConfigurationTransfer::Begin{.bytes = request.second, .sum = request.number});
    case TransferCommand::chunk: {
      std::string bytes;
      for (const std::byte byte : request.bytes) bytes += static_cast<char>(byte);
      return transfer_.serve(ConfigurationTransfer::Chunk{request.number, bytes});
    }
    case TransferCommand::commit:
    case TransferCommand::reason:
      break;
  }
  return transfer_.serve(ConfigurationTransfer::Commit{.sum = request.number});
}

}  // namespace emulator_models
