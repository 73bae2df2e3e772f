// A gate with two lanes and one with a single lane, and one free place.

#include <cstddef>
#include <span>
#include <thread>

#include "car_park.hpp"
#include "sim_clock/scenario/scenario.hpp"

namespace {

void three_cars_come_for_the_last_place(ltsim::World& world, bool (CarPark::*let_in)()) {
  const int free_places = 1;
  world.leave_segment("/car-park", std::as_bytes(std::span{&free_places, 1}));
  world.name_region("car-park", 0, sizeof free_places, "car-park.free");
  int cars = 0;
  const auto drive_in = [&](CarPark& car_park) {
    if ((car_park.*let_in)()) ++cars;
  };
  world.process("north").start("main", [&] {
    CarPark car_park{"/car-park"};
    std::thread second_lane{[&] { drive_in(car_park); }};
    drive_in(car_park);
    second_lane.join();
  });
  world.process("south").start("main", [&] {
    CarPark car_park{"/car-park"};
    drive_in(car_park);
  });
  world.run();
  world.require(cars == 1, "as many cars as places");
}

}  // namespace

SCENARIO("car-park/look-then-take", "a gate looks whether a place is free, and takes it then") {
  three_cars_come_for_the_last_place(world, &CarPark::let_in_after_a_look);
}

SCENARIO("car-park/take", "a gate takes a place if one is free, in one step") {
  three_cars_come_for_the_last_place(world, &CarPark::let_in);
}
