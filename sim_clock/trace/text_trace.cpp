#include "sim_clock/trace/text_trace.hpp"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "sim_clock/trace/value_text.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {
void TextTrace::arrives(const Task& /*task*/, const Operation& /*operation*/) noexcept { finish_write(); }

void TextTrace::performs(const Task& task, const Operation& operation) noexcept {
  finish_write();
  line(task.name, to_string(operation.kind), world_.objects().place(operation));
  if (!is_memory_access(operation.kind) || operation.object == 0) return;
  if (changes_memory(operation.kind)) {
    unfinished_write_ = operation;
    write_is_unfinished_ = true;
  } else {
    text_.insert(text_.size() - 1,
                 fmt::format(" = {}", value_text(world_, operation, world_.value_at(operation))));
  }
}

void TextTrace::blocks(const Task& task) noexcept {
  finish_write();
  line(task.name, "waits",
       fmt::format("in {} {}", to_string(world_.scheduler().pending(task).kind),
                   world_.objects().name(world_.scheduler().pending(task))));
}

void TextTrace::ends(const Task& task) noexcept {
  finish_write();
  line(task.name, "ends", "");
}

void TextTrace::older(const Task& /*task*/, const OlderStore& taken) noexcept {
  const bool reads_only = !write_is_unfinished_;
  write_is_unfinished_ = false;
  // The line of the step ends with what memory holds, if it has a value at all.
  const std::size_t line = text_.rfind('\n', text_.size() - 2) + 1;
  const std::size_t value = reads_only ? text_.find(" = ", line) : std::string::npos;
  if (value != std::string::npos) text_.erase(value, text_.size() - 1 - value);
  text_.insert(text_.size() - 1, fmt::format(" {} {} (newer stores: {})", reads_only ? "=" : ":=",
                                             reads_only ? taken.found : taken.stored, taken.newer_count));
}

void TextTrace::asks(const Task* task, std::string_view what) noexcept {
  finish_write();
  line(task == nullptr ? "" : task->name, "asks", what);
}

void TextTrace::notes(std::string_view text) noexcept {
  finish_write();
  line("", "", text);
}

std::string TextTrace::text() {
  finish_write();
  return text_;
}

void TextTrace::line(std::string_view task, std::string_view what, std::string_view place) {
  const auto now = world_.now();
  text_ += fmt::format("{:>14.3f}us  {:<18} {:<15} {}\n", static_cast<double>(now.count()) / 1000.0, task,
                       what, place);
}

void TextTrace::finish_write() {
  if (!write_is_unfinished_) return;
  write_is_unfinished_ = false;
  text_.insert(text_.size() - 1, fmt::format(" := {}", value_text(world_, unfinished_write_,
                                                                  world_.value_at(unfinished_write_))));
}

}  // namespace ltsim
