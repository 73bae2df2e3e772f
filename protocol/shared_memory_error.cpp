#include "protocol/shared_memory_error.hpp"

namespace protocol {

std::string_view to_string(SharedMemoryError error) noexcept {
  switch (error) {
    case SharedMemoryError::not_open:
      return "the shared memory is not open";
    case SharedMemoryError::cannot_open:
      return "the shared memory or its semaphore cannot be opened";
    case SharedMemoryError::segment_too_small:
      return "the shared memory of that name is too small for the areas asked for";
    case SharedMemoryError::request_too_long:
      return "the request is longer than the request area";
    case SharedMemoryError::semaphore_full:
      return "the semaphore is released already";
    case SharedMemoryError::role_taken:
      return "another process plays this side";
    case SharedMemoryError::not_made_in_time:
      return "another process has begun to make the shared memory and does not finish";
    case SharedMemoryError::other_layout:
      return "the shared memory of that name has areas of another size";
    case SharedMemoryError::other_segment:
      return "the other side is attached to another shared memory, whose name was removed";
    case SharedMemoryError::no_slave:
      return "nobody serves requests";
    case SharedMemoryError::slave_is_busy:
      return "the slave is busy with a request that was given up";
    case SharedMemoryError::rejected:
      return "the slave does not execute the request";
    case SharedMemoryError::not_executed:
      return "nobody has executed the request";
    case SharedMemoryError::unanswered:
      return "the request was taken and not answered in time";
    case SharedMemoryError::slave_gone:
      return "the slave that had taken the request is gone";
    case SharedMemoryError::damaged:
      return "the answer, or the shared memory, was damaged";
  }
  return "unknown shared memory error";
}

}  // namespace protocol
