// Whole programs, built by ltsim-cc and ltsim-c++: what they are told, what is seen of them, and what is refused.

#include <filesystem>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "tests/programs/explore_test.hpp"

namespace {

using program_tests::Result;

class ProgramsTest : public program_tests::ExploreTest {};

TEST_F(ProgramsTest, run_as_ever_without_ltsim) {
  EXPECT_EQ(shell(path_of("bank_transfer-corrected")).exit_code, 0);
  EXPECT_EQ(shell(path_of("double_close-corrected")).exit_code, 0);
}

TEST_F(ProgramsTest, are_told_their_arguments_in_each_execution_and_in_a_replay) {
  const std::string path = path_of("torn_pair_checker");
  const Result found = ltsim("explore --executions 3000 -- " + path + " 7");
  ASSERT_EQ(found.exit_code, 1) << found.output;
  EXPECT_TRUE(contains(found, "program/thread-8")) << found.output;
  EXPECT_NE(read("out/torn_pair_checker.schedule").find("program   \"" + path + "\"\nargument  \"7\"\n"),
            std::string::npos);
  const Result again = ltsim("replay out/torn_pair_checker.schedule");
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_TRUE(contains(again, "program/thread-8")) << again.output;
}

TEST_F(ProgramsTest, keep_what_the_failing_execution_has_written_and_that_of_no_other) {
  const Result found = ltsim("explore --executions 10000 -- " + path_of("bank_transfer"));
  ASSERT_EQ(found.exit_code, 1) << found.output;
  const std::string output = read("out/bank_transfer.output");
  EXPECT_NE(output, "");
  EXPECT_EQ(output.find('\n'), output.size() - 1) << output;
  EXPECT_FALSE(contains(found, output)) << found.output;
  EXPECT_TRUE(contains(ltsim("replay out/bank_transfer.schedule"), "  output:\n" + output));
}

TEST_F(ProgramsTest, are_proved_as_scenarios_are) {
  const Result whole = ltsim("prove -- " + path_of("atomic_two_steps-corrected"));
  EXPECT_EQ(whole.exit_code, 0) << whole.output;
  EXPECT_TRUE(contains(whole, "with any number of preemptions and no silence")) << whole.output;
  EXPECT_EQ(ltsim("prove -- " + path_of("atomic_two_steps")).exit_code, 1);
}

TEST_F(ProgramsTest, give_the_same_report_for_the_same_seed) {
  const std::string command =
      "explore --executions 2000 --keep-going --seed 5 -- " + path_of("vector_push_back");
  const Result once = ltsim(command);
  EXPECT_EQ(once.exit_code, 1) << once.output;
  EXPECT_EQ(once.output, ltsim(command).output);
}

TEST_F(ProgramsTest, begin_each_execution_with_the_memory_that_main_was_called_with) {
  build("p.cpp", R"(
    #include <cstring>
    #include <string>
    #include <thread>
    #include <vector>
    std::vector<int> made_before_main{1, 2, 3};
    thread_local int of_thread = 5;
    int calls = 0;
    int main(int, char** arguments) {
      const bool as_it_was = calls++ == 0 && made_before_main.size() == 3 && made_before_main[0] == 1 && of_thread++ == 5 &&
                             std::strcmp(arguments[1], "word") == 0;
      made_before_main[0] = 7;
      made_before_main.push_back(4);
      arguments[1][0] = 'W';
      std::thread{[] { std::string{"some work"}; }}.join();
      return as_it_was ? 0 : 1;
    })");
  const Result result = ltsim("explore --executions 100 -- ./p word");
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

TEST_F(ProgramsTest, exit_as_programs_do) {
  build("p.cpp", R"(
    #include <cstdio>
    #include <cstdlib>
    #include <cstring>
    #include <thread>
    #include <unistd.h>
    struct Tells {
      const char* what;
      ~Tells() { std::puts(what); }
    };
    Tells of_program{"static"};
    thread_local Tells of_thread{"thread-local"};
    int main(int, char** arguments) {
      static Tells of_function{"static of a function"};
      std::atexit([] { std::puts("handler"); });
      if (of_thread.what == nullptr) return 9;
      std::thread{[how = arguments[1]] {
        if (std::strcmp(how, "exit") == 0) std::exit(3);
        if (std::strcmp(how, "_exit") == 0) _exit(4);
        if (std::strcmp(how, "_Exit") == 0) std::_Exit(4);
      }}.join();
      return 5;
    })");
  EXPECT_EQ(ltsim("explore -- ./p return").exit_code, 1);
  EXPECT_EQ(read("out/p.output"), "thread-local\nhandler\nstatic of a function\nstatic\n");
  const Result by_thread = ltsim("explore -- ./p exit");
  EXPECT_TRUE(contains(by_thread, "exit: the program ended with status 3")) << by_thread.output;
  EXPECT_EQ(read("out/p.output"),
            "handler\nstatic of a function\nstatic\n");  // the thread has none of its own
  for (const std::string how : {"_exit", "_Exit"}) {
    std::filesystem::remove(folder_.path() / "out/p.output");
    const Result at_once = ltsim("explore -- ./p " + how);
    EXPECT_TRUE(contains(at_once, "exit: the program ended with status 4")) << at_once.output;
    EXPECT_EQ(read("out/p.output"), "") << how;
  }
}

TEST_F(ProgramsTest, are_told_what_they_do_to_their_heap) {
  build("p.cpp", R"(
    #include <cstdlib>
    #include <cstring>
    #include <new>
    int* volatile block;
    int* volatile other;
    int main(int, char** arguments) {
      const auto is = [&](const char* what) { return std::strcmp(arguments[1], what) == 0; };
      block = static_cast<int*>(std::malloc(10 * sizeof(int)));
      if (is("reads behind")) return block[10];
      if (is("writes before")) block[-1] = 1;
      if (is("frees within")) std::free(block + 1);
      if (is("uses what it moved")) {
        other = static_cast<int*>(std::realloc(block, 4000));
        block[0] = 1;
      }
      if (is("loses")) block = nullptr;
      volatile std::size_t more_than_there_is = std::size_t{1} << 60U;
      if (is("asks for too much")) other = new int[more_than_there_is];
      if (is("does well")) {
        block[9] = 9;
        other = static_cast<int*>(std::realloc(block, 11 * sizeof(int)));
        if (other[9] != 9) return 1;
        other[10] = 10;
        std::free(other);
        block = static_cast<int*>(std::calloc(2, sizeof(int)));
        if (block[0] != 0 || block[1] != 0) return 1;
        other = new (std::nothrow) int[1];
        delete[] other;
        struct alignas(64) Wide {
          char bytes[64];
        };
        Wide* const wide = new Wide;
        if (reinterpret_cast<unsigned long>(wide) % 64 != 0) return 1;
        delete wide;
      }
      std::free(block);
      return 0;
    })");
  const struct {
    const char* argument;
    const char* told;
  } cases[] = {
      {"reads behind",
       "crash: program/main reads at p.cpp:10: 4 bytes at heap.main-1[40], beyond its end: 40 bytes, "
       "allocated at p.cpp:9"},
      {"writes before", "crash: program/main writes at p.cpp:11: "},
      {"frees within", "crash: program/main frees an address where no block begins: heap.main-1[4]"},
      {"uses what it moved",
       "crash: program/main writes at p.cpp:15: heap.main-1[0] after it was freed: 40 bytes, "
       "allocated at p.cpp:9, freed by program/main at p.cpp:14"},
      {"loses", "leak: heap.main-1 is lost: 40 bytes, allocated at p.cpp:9"},
      {"asks for too much", "crash: program/main: nobody caught the exception \"std::bad_alloc\""},
  };
  for (const auto& [argument, told] : cases) {
    const Result result = ltsim("explore -- ./p '" + std::string{argument} + "'");
    EXPECT_EQ(result.exit_code, 1) << argument;
    EXPECT_TRUE(contains(result, told)) << result.output;
  }
  const Result result = ltsim("explore --executions 10 -- ./p 'does well'");
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

TEST_F(ProgramsTest, are_told_of_a_block_that_is_freed_while_a_thread_stands_before_its_access) {
  build("p.cpp", R"(
    #include <atomic>
    #include <thread>
    std::atomic<bool> is_there{false};
    int main() {
      int* const block = new int{7};
      std::thread reader{[=] {
        is_there = true;
        if (*block != 7) std::abort();
      }};
      while (!is_there) std::this_thread::yield();
      delete block;
      reader.join();
    })");
  const Result result = ltsim("explore --executions 1000 --keep-going -- ./p");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(contains(result, "data-race: ")) << result.output;
  EXPECT_TRUE(contains(result, "crash: program/thread-1 reads at p.cpp:9: heap.main-1[0] after it was freed"))
      << result.output;
}

TEST_F(ProgramsTest, may_exit_before_a_detached_thread_has_begun) {
  build("p.cpp", R"(
    #include <string>
    #include <thread>
    int main() {
      std::thread{[text = std::string(100, 'x')] {}}.detach();
    })");
  const Result result = ltsim("explore --executions 100 -- ./p");
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

TEST_F(ProgramsTest, wait_for_signals_and_may_ignore_them_but_have_no_handlers) {
  build("p.cpp", R"(
    #include <errno.h>
    #include <pthread.h>
    #include <signal.h>
    #include <unistd.h>
    #include <thread>
    int main() {
      if (signal(SIGPIPE, SIG_IGN) != SIG_DFL || signal(SIGPIPE, SIG_IGN) != SIG_IGN) return 3;
      if (kill(getpid(), SIGPIPE) != 0 || signal(SIGKILL, SIG_IGN) != SIG_ERR || errno != EINVAL) return 4;
      sigset_t set;
      sigset_t before;
      sigemptyset(&set);
      sigaddset(&set, SIGUSR2);
      sigaddset(&set, SIGUSR1);
      pthread_sigmask(SIG_BLOCK, &set, nullptr);
      pthread_sigmask(SIG_BLOCK, nullptr, &before);
      if (sigismember(&before, SIGUSR1) != 1 || sigismember(&before, SIGTERM) != 0) return 5;
      std::thread{[] {
        sigset_t mine;
        pthread_sigmask(SIG_BLOCK, nullptr, &mine);
        if (sigismember(&mine, SIGUSR1) == 1) kill(getpid(), SIGUSR2);
      }}.join();
      kill(getpid(), SIGUSR1);
      int signal = 0;
      if (sigwait(&set, &signal) != 0 || signal != SIGUSR1) return 6;  // the lowest one first
      siginfo_t told;
      if (sigwaitinfo(&set, &told) != SIGUSR2 || told.si_signo != SIGUSR2) return 7;
      const timespec pause{.tv_sec = 0, .tv_nsec = 1'000'000};
      if (sigtimedwait(&set, nullptr, &pause) != -1 || errno != EAGAIN) return 8;
    })");
  const Result result = ltsim("explore --executions 100 -- ./p");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  build("p.cpp", R"(
    #include <signal.h>
    #include <unistd.h>
    int main(int count, char**) {
      if (count == 1) kill(getpid(), SIGTERM);
      signal(SIGTERM, [](int) {});
    })");
  const Result ended = ltsim("explore -- ./p");
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_TRUE(contains(ended, "crash: program was ended by signal 15, Terminated")) << ended.output;
  const Result refused = ltsim("explore -- ./p handler");
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_TRUE(contains(refused,
                       "program/main called signal with a handler, which ltsim does not simulate: block "
                       "the signal and wait for it with sigwait(3)"))
      << refused.output;
}

TEST_F(ProgramsTest, leave_no_descriptor_open_for_the_next_execution) {
  build("p.cpp", R"(
    #include <fcntl.h>
    #include <stdio.h>
    #include <unistd.h>
    int main() {
      const int file = open("/dev/null", O_RDONLY);
      if (file > 100 || openat(AT_FDCWD, "/dev/null", O_RDONLY) < 0 || dup(file) < 0 ||
          fcntl(file, F_DUPFD_CLOEXEC, 0) < 0 || fopen("/dev/null", "r") == nullptr)
        return 3;
    })");
  const Result result = ltsim("explore --executions 300 -- ./p");
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

TEST_F(ProgramsTest, have_atomic_instructions_in_their_inline_assembly_seen) {
  const std::string source = R"(
    #include <cstring>
    #include <thread>
    unsigned char is_locked = 0;
    int counted = 0;         // by who has the lock
    long counted_by_both = 0;
    unsigned char exchange(unsigned char value) {
      asm volatile("xchgb %0, %1" : "+q"(value), "+m"(is_locked) : : "memory");
      return value;
    }
    long add(long value) {
      asm volatile("lock\n\txaddq %0, %1" : "+r"(value), "+m"(counted_by_both) : : "memory", "cc");
      return value;
    }
    bool replace(long found, long value) {
      unsigned char done = 0;
      asm volatile("1: lock; cmpxchgq %3, %1\n\tsete %2"
                   : "+a"(found), "+m"(counted_by_both), "=q"(done) : "r"(value) : "memory", "cc");
      return done != 0;
    }
    void count() {
      while (exchange(1) != 0) std::this_thread::yield();
      ++counted;
      exchange(0);
      long found = add(0);
      while (!replace(found, found + 1)) found = add(0);
    }
    void count_in_two_steps() { add(add(0) == 0 ? 1 : 2); }
    int main(int, char** arguments) {
      const auto work = std::strcmp(arguments[1], "well") == 0 ? count : count_in_two_steps;
      std::thread one{work};
      std::thread two{work};
      one.join();
      two.join();
      if (work == count_in_two_steps) return counted_by_both == 3 ? 0 : 1;
      return counted == 2 && counted_by_both == 2 ? 0 : 1;
    })";
  build("p.cpp", source);
  const Result well = ltsim("explore --executions 2000 -- ./p well");
  EXPECT_EQ(well.exit_code, 0) << well.output;
  const Result badly = ltsim("explore --executions 2000 -- ./p badly");
  EXPECT_EQ(badly.exit_code, 1) << badly.output;
  EXPECT_TRUE(contains(badly, "exit: the program ended with status 1")) << badly.output;
  EXPECT_TRUE(contains(badly, "updates  counted_by_both")) << badly.output;
  const Result weak = ltsim("explore --executions 10 --memory c11 -- ./p well");
  EXPECT_EQ(weak.exit_code, 3) << weak.output;
  EXPECT_TRUE(contains(weak, "performs an atomic operation by inline assembly")) << weak.output;
  build("p.cpp", source, "-pipe");
  const Result piped = ltsim("explore --executions 2000 -- ./p well");
  EXPECT_EQ(piped.exit_code, 0) << piped.output;
}

TEST_F(ProgramsTest, may_write_plainly_where_an_atomic_store_was_that_they_have_acquired) {
  build("p.cpp", R"(
    #include <atomic>
    #include <new>
    #include <thread>
    alignas(std::atomic<int>) unsigned char node[sizeof(std::atomic<int>)];
    int main() {
      auto* const link = new (node) std::atomic<int>{0};
      std::thread owner{[=] {
        while (link->load(std::memory_order_acquire) == 0) std::this_thread::yield();
        *new (node) int = 2;
      }};
      link->store(1, std::memory_order_release);
      owner.join();
    })");
  for (const std::string memory : {"sc", "c11"}) {
    const Result result = ltsim("explore --executions 1000 --memory " + memory + " -- ./p");
    EXPECT_EQ(result.exit_code, 0) << result.output;
  }
}

TEST_F(ProgramsTest, keep_their_registers_around_what_is_seen_of_their_inline_assembly) {
  build("p.cpp", R"(
    unsigned half = 0xffff0000U;
    int main() {
      // What lies below the stack pointer, the flags, registers of all kinds.
      unsigned long below = 0, rest = 0;
      double kept = 1.5;
      unsigned char carry = 0, is_negative = 0;
      asm volatile(
          "movq $77, -8(%%rsp)\n\tstc\n\tmovq $5, %%r11\n\t"
          "lock incl %4\n\tsetc %2\n\tsets %3\n\t"
          "movq -8(%%rsp), %0\n\taddq $6, %%r11\n\tmovq %%r11, %1"
          : "=&r"(below), "=&r"(rest), "=&q"(carry), "=&q"(is_negative), "+m"(half), "+x"(kept) : : "r11", "cc", "memory");
      return below == 77 && rest == 11 && carry == 1 && is_negative == 1 && half == 0xffff0001U && kept == 1.5 ? 0 : 1;
    })");
  EXPECT_EQ(shell("./p").exit_code, 0);
  const Result result = ltsim("explore --executions 10 -- ./p");
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

TEST_F(ProgramsTest, are_refused_with_the_reason_where_they_cannot_be_looked_into) {
  write("script", "#!/bin/sh\nexit 0\n");
  write("empty", "");
  const struct {
    const char* arguments;
    const char* reason;
  } cases[] = {
      {"explore --", "no program follows \"--\""},
      {"explore -- ./none-such", "./none-such: No such file or directory"},
      {"explore -- ./script", "./script: is no program: a script cannot be looked into"},
      {"explore -- ./empty", "./empty: is no program"},
      {"explore -- .", ".: is no program"},
      {"explore -- /bin/true", "/bin/true: was not built with ltsim-cc or ltsim-c++"},
  };
  for (const auto& [arguments, reason] : cases) {
    const Result result = ltsim(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_TRUE(contains(result, std::string{"ltsim: "} + reason)) << result.output;
  }
}

TEST_F(ProgramsTest, are_not_compiled_where_they_could_not_be_looked_into) {
  write("p.c", "int main(void) { return 0; }\n");
  const Result is_static = shell(LTSIM_CC " -static p.c -o p");
  EXPECT_EQ(is_static.exit_code, 2);
  EXPECT_TRUE(contains(is_static, "ltsim-cc: -static: ")) << is_static.output;
  const Result sanitizer = shell(LTSIM_CC " -fsanitize=address p.c -o p");
  EXPECT_EQ(sanitizer.exit_code, 2);
  EXPECT_TRUE(contains(sanitizer, "ltsim-cc: -fsanitize=address: ")) << sanitizer.output;
}

TEST_F(ProgramsTest, may_have_races_and_leaks_that_are_no_failures) {
  // With memory sc nothing comes of its race.
  EXPECT_EQ(ltsim("explore --executions 300 -- " + path_of("publish_relaxed")).exit_code, 1);
  EXPECT_EQ(ltsim("explore --executions 300 --races off -- " + path_of("publish_relaxed")).exit_code, 0);
  const Result proved = ltsim("prove --races off -- " + path_of("publish_relaxed"));
  EXPECT_EQ(proved.exit_code, 0) << proved.output;
  EXPECT_TRUE(contains(proved, "memory sc, races off")) << proved.output;
  EXPECT_EQ(ltsim("explore --executions 300 -- " + path_of("cache_leak")).exit_code, 1);
  EXPECT_EQ(ltsim("explore --executions 300 --leaks off -- " + path_of("cache_leak")).exit_code, 0);
  // What comes of a race shows where the race itself is no failure, and again where only the schedule says that it is none.
  const Result found = ltsim("explore --executions 10000 --races off -- " + path_of("torn_pair"));
  EXPECT_EQ(found.exit_code, 1) << found.output;
  EXPECT_TRUE(contains(found, "exit: the program ended with status 1")) << found.output;
  EXPECT_NE(read("out/torn_pair.schedule").find("races     off\n"), std::string::npos);
  const Result again = ltsim("replay out/torn_pair.schedule");
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_FALSE(contains(again, "not as recorded")) << again.output;
}

}  // namespace
