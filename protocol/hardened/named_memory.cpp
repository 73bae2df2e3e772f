#include "protocol/hardened/named_memory.hpp"

#include <boost/interprocess/shared_memory_object.hpp>

#include <sys/stat.h>

namespace protocol::hardened {

namespace {

namespace ipc = boost::interprocess;

std::optional<struct stat> status_of(const ipc::shared_memory_object& memory) noexcept {
  struct stat status = {};
  if (::fstat(memory.get_mapping_handle().handle, &status) != 0) return std::nullopt;
  return status;
}

}  // namespace

std::optional<NamedMemory::Error> NamedMemory::open(const std::string& name,
                                                    std::size_t size_bytes) noexcept {
  try {
    ipc::shared_memory_object memory(ipc::open_or_create, name.c_str(), ipc::read_write);
    auto status = status_of(memory);
    if (status && status->st_size == 0) {
      memory.truncate(static_cast<ipc::offset_t>(size_bytes));
      status->st_size = static_cast<off_t>(size_bytes);
    }
    if (!status) return Error::cannot_open;
    if (static_cast<std::size_t>(status->st_size) != size_bytes) return Error::other_size;
    region = ipc::mapped_region(memory, ipc::read_write, 0, size_bytes);
    identity = status->st_ino;
    return std::nullopt;
  } catch (...) {  // interprocess_exception: the system's refusal
    return Error::cannot_open;
  }
}

std::optional<MemoryIdentity> NamedMemory::identity_of(const std::string& name) noexcept {
  try {
    const ipc::shared_memory_object memory(ipc::open_only, name.c_str(), ipc::read_only);
    const auto status = status_of(memory);
    return status ? std::optional<MemoryIdentity>(status->st_ino) : std::nullopt;
  } catch (...) {
    return std::nullopt;
  }
}

bool NamedMemory::remove(const std::string& name) noexcept {
  return ipc::shared_memory_object::remove(name.c_str());
}

}  // namespace protocol::hardened
