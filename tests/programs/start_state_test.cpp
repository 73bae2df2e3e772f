// What each execution of a whole program begins with: ltsim explore --state restore|fork.

#include <string>

#include <gtest/gtest.h>

#include "tests/programs/explore_test.hpp"

namespace {

using program_tests::Result;

class StartStateTest : public program_tests::ExploreTest {};

/// Each argument is a way in which something outside of the program's memory survives an execution.
constexpr const char* keeps_something = R"(
  #include <clocale>
  #include <cstdio>
  #include <cstdlib>
  #include <cstring>
  #include <thread>
  int main(int, char** arguments) {
    const auto is = [&](const char* what) { return std::strcmp(arguments[1], what) == 0; };
    std::thread{[] {}}.join();
    if (is("environment")) {
      if (std::getenv("WAS_HERE") != nullptr) return 1;
      setenv("WAS_HERE", "yes", 1);
    }
    if (is("locale")) {
      if (std::strcmp(std::setlocale(LC_CTYPE, nullptr), "C") != 0) return 1;
      std::setlocale(LC_CTYPE, "C.UTF-8");
    }
    if (is("stream")) {
      if (std::feof(stdin)) return 1;
      while (std::getc(stdin) != EOF) {}
    }
    if (is("traces")) {
      const char* const before = std::getenv("TIMES");
      const int times = before == nullptr ? 1 : std::atoi(before) + 1;
      setenv("TIMES", std::to_string(times).c_str(), 1);
      for (int i = 0; i < times; ++i) std::this_thread::yield();
    }
    return 0;
  })";

TEST_F(StartStateTest, keep_what_libraries_have_come_to_unless_each_execution_has_a_process) {
  build("p.cpp", keeps_something);
  for (const std::string what : {"environment", "locale", "stream"}) {
    const Result restored = ltsim("explore --executions 100 -- ./p " + what + " </dev/null");
    EXPECT_EQ(restored.exit_code, 1) << what << restored.output;
    EXPECT_TRUE(contains(restored, "executions, memory put back before each execution\n")) << restored.output;
    const Result forked = ltsim("explore --executions 100 --state fork -- ./p " + what + " </dev/null");
    EXPECT_EQ(forked.exit_code, 0) << what << forked.output;
    EXPECT_TRUE(contains(forked, "executions, each execution in a process of its own\n")) << forked.output;
  }
}

TEST_F(StartStateTest, are_told_the_way_out_where_two_runs_of_a_seed_differ_for_what_a_library_keeps) {
  build("p.cpp", keeps_something);
  const Result restored = ltsim("explore -- ./p traces");
  EXPECT_EQ(restored.exit_code, 3) << restored.output;
  EXPECT_TRUE(contains(restored, "\"--state fork\" gives each execution a process of its own"))
      << restored.output;
  EXPECT_EQ(ltsim("explore --executions 200 --state fork -- ./p traces").exit_code, 0);
}

TEST_F(StartStateTest, begin_with_the_descriptors_that_they_were_started_with) {
  build("p.cpp", R"(
    #include <cstring>
    #include <fcntl.h>
    #include <unistd.h>
    int main(int, char** arguments) {
      char line[6] = "";
      if (read(STDIN_FILENO, line, 5) != 5 || std::strcmp(line, "input") != 0) return 1;
      if (std::strcmp(arguments[1], "leaves") == 0 && open("/dev/null", O_RDONLY) < 0) return 2;
      if (std::strcmp(arguments[1], "closes") == 0 && close(STDIN_FILENO) != 0) return 3;
      return 0;
    })");
  write("words", "input of the program");
  // More than a process may have open.
  for (const std::string state : {"restore", "fork"}) {
    const std::string command =
        "ulimit -n 1024; " LTSIM_PROGRAM " explore --executions 1200 --state " + state + " -- ./p ";
    const Result left = shell(command + "leaves <words");
    EXPECT_EQ(left.exit_code, 0) << left.output;
    EXPECT_EQ(contains(left, " open: closed before the next."), state == "restore") << left.output;
    const Result closed = shell(command + "closes <words");
    EXPECT_EQ(closed.exit_code, 0) << closed.output;
    EXPECT_FALSE(contains(closed, " open: closed before the next.")) << closed.output;
  }
}

TEST_F(StartStateTest, go_the_same_way_whether_they_are_restored_or_forked) {
  // What the strategies learn must come back from the processes: without it the executions are others from the second on.
  const auto explored = [&](const std::string& options, const std::string& name) {
    const Result result =
        ltsim("explore --executions 600 --minimize-seconds 0 " + options + " -- " + path_of(name));
    // Without the first line, which says which of the two it is, and what the real time has been.
    std::string told = result.output.substr(result.output.find('\n') + 1);
    if (result.exit_code == 0) told.erase(told.rfind(','));
    return told;
  };
  for (const std::string strategy : {"swarm", "pct", "pos", "surw", "stall", "random"}) {
    for (const std::string name : {"condition_if-corrected", "start_gate-corrected", "two_stage"}) {
      const std::string options = "--seed 7 --strategy " + strategy;
      EXPECT_EQ(explored(options + " --state fork", name), explored(options, name))
          << strategy << " " << name;
    }
  }
  const std::string all = "--keep-going --memory c11";
  EXPECT_EQ(explored(all + " --state fork", "work_stealing_fence"), explored(all, "work_stealing_fence"));
}

TEST_F(StartStateTest, have_a_failure_made_small_and_replayed_from_processes_of_their_own) {
  build("p.cpp", R"(
    #include <cstdlib>
    #include <mutex>
    #include <thread>
    std::mutex lock;
    int value = 0;
    int main() {
      if (std::getenv("WAS_HERE") != nullptr) return 2;
      setenv("WAS_HERE", "yes", 1);
      const auto add = [] {
        int seen = 0;
        { const std::lock_guard guard{lock}; seen = value; }
        { const std::lock_guard guard{lock}; value = seen + 1; }
      };
      std::thread one{add};
      std::thread other{add};
      one.join();
      other.join();
      return value == 2 ? 0 : 1;
    })");
  const Result found = ltsim("explore --state fork -- ./p");
  EXPECT_EQ(found.exit_code, 1) << found.output;
  EXPECT_TRUE(contains(found, "exit: the program ended with status 1")) << found.output;
  EXPECT_TRUE(contains(found, "minimized to 1,")) << found.output;
  EXPECT_TRUE(contains(found, "story: ")) << found.output;
  EXPECT_NE(read("out/p.schedule").find("state     fork\n"), std::string::npos);
  for (const std::string command : {"replay out/p.schedule", "minimize out/p.schedule"}) {
    const Result again = ltsim(command);
    EXPECT_EQ(again.exit_code, 1) << again.output;
    EXPECT_TRUE(contains(again, "exit: the program ended with status 1")) << again.output;
    EXPECT_FALSE(contains(again, "not as recorded")) << again.output;
  }
}

TEST_F(StartStateTest, may_hang_and_die_in_processes_of_their_own) {
  build("p.cpp", R"(
    #include <cstring>
    #include <sys/mman.h>
    #include <thread>
    int main(int, char** arguments) {
      std::thread{[] {}}.join();
      if (std::strcmp(arguments[1], "hang") == 0)
        for (;;) __asm__ volatile("");
      // exit_group(2) by nobody's function: nothing of it is seen.
      __asm__ volatile("mov $231, %%eax; mov $0, %%edi; syscall" ::: "rax", "rdi", "rcx", "r11");
    })");
  const Result hangs = ltsim("explore --state fork --hang-seconds 0.5 -- ./p hang");
  EXPECT_EQ(hangs.exit_code, 1) << hangs.output;
  EXPECT_TRUE(contains(hangs, "livelock: no scheduling point for 0.5 s")) << hangs.output;
  EXPECT_TRUE(contains(hangs, " --state fork -- ./p hang")) << hangs.output;
  const Result dies = ltsim("explore --state fork -- ./p die");
  EXPECT_EQ(dies.exit_code, 1) << dies.output;
  EXPECT_TRUE(contains(dies, "crash: worker exited with code 0")) << dies.output;
}

}  // namespace
