// The first scenario of the README: two processes count in shared memory, without a lock.

#include <boost/interprocess/mapped_region.hpp>
#include <boost/interprocess/shared_memory_object.hpp>

#include "sim_clock/scenario/scenario.hpp"

namespace {

namespace ipc = boost::interprocess;

// Code under test: it knows nothing of the simulation.
void count_one_part() {
  ipc::shared_memory_object segment(ipc::open_or_create, "parts", ipc::read_write);
  segment.truncate(sizeof(int));
  ipc::mapped_region memory(segment, ipc::read_write);
  int& parts = *static_cast<int*>(memory.get_address());
  parts = parts + 1;
}

int parts_counted() {
  ipc::shared_memory_object segment(ipc::open_only, "parts", ipc::read_only);
  ipc::mapped_region memory(segment, ipc::read_only);
  return *static_cast<const int*>(memory.get_address());
}

}  // namespace

SCENARIO("demo/parts-counter", "two processes count parts in shared memory, without a lock") {
  world.name_region("parts", 0, sizeof(int), "parts.count");
  // Without this line nearly every execution fails, as a data race that names the two lines. Here it is shown
  // what comes of it.
  world.allow_data_races();
  int finished = 0;
  for (const char* name : {"lathe", "mill"}) {
    world.process(name).start("main", [&] {
      count_one_part();
      if (++finished == 2) world.require(parts_counted() == 2, "a part was not counted");
    });
  }
  world.run();
}
