#include "sim_clock/world/object_names.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "sim_clock/world/program_memory.hpp"
#include "sim_clock/world/same_name.hpp"
#include "sim_clock/world/watched_accesses.hpp"

namespace ltsim {
void make_one_word(std::string& name) {
  if (name.empty()) name.push_back('_');
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }, '_');
}

void ObjectNames::reset() noexcept {
  names_count_ = 0;
  regions_count_ = 0;
}

// The next execution of a scenario mostly gives the same names in the same order: what lies in the pool is then right already.

ObjectId ObjectNames::add(std::string_view name) {
  if (name.starts_with('/')) name.remove_prefix(1);
  if (names_count_ == names_.size()) names_.emplace_back();
  std::string& stored = names_[names_count_];
  if (!is_same_name(stored, name)) {
    const UnwatchedWrites unwatched;
    stored.assign(name);
    make_one_word(stored);
  }
  return static_cast<ObjectId>(++names_count_);
}

void ObjectNames::name_region(std::string_view object_name, std::uint32_t offset, std::uint32_t bytes,
                              std::string_view region) {
  if (regions_count_ == regions_.size()) regions_.emplace_back();
  Region& entry = regions_[regions_count_++];
  entry.offset = offset;
  entry.bytes = bytes;
  if (entry.object_name != object_name) entry.object_name.assign(object_name);
  if (entry.name != region) {
    entry.name.assign(region);
    make_one_word(entry.name);
  }
}

std::string ObjectNames::name(const Operation& operation) const {
  if (operation.object == 0) return is_memory_access(operation.kind) ? "memory" : "-";
  if (ProgramMemory::is_object(operation.object)) return program_memory_.name(operation);
  const Region* const region = region_of(operation);
  return region != nullptr ? region->name : std::string{object_name(operation.object)};
}

std::string ObjectNames::place(const Operation& operation) const {
  if (!is_memory_access(operation.kind) || operation.object == 0) return name(operation);
  if (ProgramMemory::is_object(operation.object)) return program_memory_.place(operation);
  const Region* const region = region_of(operation);
  if (region == nullptr) return fmt::format("{}[{}]", object_name(operation.object), operation.offset);
  if (region->bytes <= operation.bytes) return region->name;
  return fmt::format("{}[{}]", region->name, operation.offset - region->offset);
}

std::string_view ObjectNames::object_name(ObjectId object) const noexcept {
  return object == 0 || object > names_count_ ? std::string_view{"-"} : std::string_view{names_[object - 1]};
}

const ObjectNames::Region* ObjectNames::region_of(const Operation& operation) const noexcept {
  if (!is_memory_access(operation.kind)) return nullptr;
  for (std::size_t i = 0; i < regions_count_; ++i) {
    const Region& region = regions_[i];
    if (operation.offset >= region.offset && operation.offset - region.offset < region.bytes &&
        region.object_name == object_name(operation.object)) {
      return &region;
    }
  }
  return nullptr;
}

}  // namespace ltsim
