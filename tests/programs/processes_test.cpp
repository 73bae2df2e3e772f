// Whole programs as the processes of one world: images that ltsim-c++ --process has built, loaded side by side.

#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "tests/programs/explore_test.hpp"

namespace {

using program_tests::Result;

class ProcessesTest : public program_tests::ExploreTest {
 protected:
  /// NAME.so from this source.
  void build_image(const std::string& name, const std::string& source) const {
    write(name + ".cpp", source);
    const Result built = compile("--process " + name + ".cpp -o " + name + ".so");
    ASSERT_EQ(built.exit_code, 0) << built.output;
  }
  /// What the processes write in an execution without any deviation, and how that ends.
  [[nodiscard]] Result run_once(const std::string& scenario, const std::string& arguments) const {
    write("once.schedule", "ltsim schedule 1\nscenario  " + scenario +
                               "\nmemory    sc\noutcome   passed\nprogram   \"ltsim-processes\"\n" +
                               arguments);
    return ltsim("replay once.schedule");
  }
};

/// What both sides of a mailbox in shared memory begin with.
constexpr const char* mailbox = R"(
  #include <fcntl.h>
  #include <pthread.h>
  #include <semaphore.h>
  #include <signal.h>
  #include <sys/mman.h>
  #include <unistd.h>
  #include <cstdio>
  #include <cstdlib>
  #include <cstring>
  #include <string>
  #include <thread>
  struct Mailbox { int request; int answer; int lives; };
  static sem_t* asked = nullptr;
  static sem_t* answered = nullptr;
  static Mailbox* attach() {
    asked = sem_open("/asked", O_CREAT, 0600, 0);
    answered = sem_open("/answered", O_CREAT, 0600, 0);
    const int file = shm_open("/mailbox", O_CREAT | O_RDWR, 0600);
    if (ftruncate(file, sizeof(Mailbox)) != 0) std::abort();
    return static_cast<Mailbox*>(
        mmap(nullptr, sizeof(Mailbox), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0));
  }
  static int runs = 0;                                             // of this image, and of this life of it
  static std::string* const kept = new std::string(100, 'x');      // on the heap, before main()
  static struct Last { ~Last() { std::puts(runs == 1 ? "goodbye" : "no goodbye"); } } last;
)";

/// Asks, and expects twice its argument.
constexpr const char* kernel = R"(
  int main(int count, char** arguments) {
    if (++runs != 1 || kept->size() != 100) return 3;
    kept->resize(10);
    Mailbox* const box = attach();
    box->request = count > 1 ? std::atoi(arguments[1]) : 1;
    sem_post(asked);
    sem_wait(answered);
    std::printf("%s: %d\n", std::strrchr(arguments[0], '/') + 1, box->answer);
    return box->answer == 2 * box->request ? 0 : 1;
  })";

/// A thread answers once; the main one waits to be stopped.
constexpr const char* emulator = R"(
  int main() {
    if (++runs != 1 || kept->size() != 100) return 3;
    kept->resize(20);
    sigset_t stop;
    sigemptyset(&stop);
    sigaddset(&stop, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &stop, nullptr);
    Mailbox* const box = attach();
    std::thread server{[=] {
      sem_wait(asked);
      box->answer = 2 * box->request;
      sem_post(answered);
    }};
    int signal = 0;
    sigwait(&stop, &signal);
    std::printf("stopped by %d\n", signal);
    server.join();
    return 0;
  })";

TEST_F(ProcessesTest, have_variables_and_a_heap_of_their_own_and_begin_each_execution_alike) {
  build_image("kernel", std::string{mailbox} + kernel);
  build_image("emulator", std::string{mailbox} + emulator);
  const Result result = ltsim("explore --executions 300 --service ./emulator.so --process ./kernel.so:21");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_TRUE(contains(result.output, "emulator+kernel  nothing found: 300 executions")) << result.output;
}

TEST_F(ProcessesTest, are_services_that_are_waited_for_and_stopped_or_processes_that_end) {
  build_image("kernel", std::string{mailbox} + kernel);
  build_image("emulator", std::string{mailbox} + emulator);
  const Result once = run_once("emulator+kernel", R"(argument  "--service=./emulator.so"
argument  "--process=./kernel.so:21"
)");
  EXPECT_EQ(once.exit_code, 0) << once.output;
  EXPECT_TRUE(contains(once.output, "kernel.so: 42\ngoodbye\nstopped by 15\ngoodbye\n")) << once.output;
  const Result never_stopped = ltsim("explore --process ./emulator.so --process ./kernel.so:21");
  EXPECT_EQ(never_stopped.exit_code, 1);
  EXPECT_TRUE(contains(never_stopped.output, "deadlock: emulator/main waits in signal_wait"))
      << never_stopped.output;
  build_image("polls", R"(
    #include <unistd.h>
    int main() {
      for (;;) usleep(1'000'000);
    })");
  const Result never_ready = ltsim("explore --service ./polls.so --process ./kernel.so");
  EXPECT_EQ(never_ready.exit_code, 3);
  EXPECT_TRUE(contains(never_ready.output, "a service has not waited for SIGTERM within 60 s"))
      << never_ready.output;
}

TEST_F(ProcessesTest, of_one_image_are_kept_apart) {
  build_image("kernel", std::string{mailbox} + kernel);
  build_image("emulator", std::string{mailbox} + emulator);
  // The emulator answers once.
  const Result result = ltsim(
      "explore --executions 100 --keep-going --service ./emulator.so --process ./kernel.so:21 --process "
      "./kernel.so:4");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(
      contains(result.output, "kernel-2/main waits in sem_wait answered, and nobody is left to post it"))
      << result.output;
  EXPECT_FALSE(contains(result.output, "status 3")) << result.output;
}

TEST_F(ProcessesTest, that_are_killed_begin_again_as_new) {
  build_image("kernel", std::string{mailbox} + kernel);
  build_image("emulator", std::string{mailbox} + R"(
    int main() {
      if (++runs != 1 || kept->size() != 100) return 3;
      kept->resize(20);
      Mailbox* const box = attach();
      std::thread{[] {}}.join();
      sem_wait(asked);
      ++box->lives;
      if (box->lives == 2) return 7;
      sem_post(asked);
      sem_wait(answered);
      sem_wait(asked);
      return 0;
    })");
  // In its second life it comes by, unless its memory were that of the first.
  const Result result = ltsim(
      "explore --executions 2000 --process ./emulator.so --process ./kernel.so:21 "
      "--exit-status 0,1 --crash emulator:5 --keep-going");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(contains(result.output, "exit: emulator ended with status 7")) << result.output;
  EXPECT_FALSE(contains(result.output, "status 3")) << result.output;
}

TEST_F(ProcessesTest, that_are_killed_have_lost_nothing) {
  build_image("keeper", R"(
    #include <unistd.h>
    static int* kept = nullptr;
    [[gnu::noinline]] void fill() { kept = new int{1}; }
    int main(int count, char**) {
      fill();
      usleep(1000);
      if (count == 1) delete kept;
      kept = nullptr;
    })");
  const Result silent =
      ltsim("explore --executions 200 --process ./keeper.so --process ./keeper.so --crash keeper:1");
  EXPECT_EQ(silent.exit_code, 0) << silent.output;
  const Result told = ltsim("explore --process ./keeper.so --process ./keeper.so:lose");
  EXPECT_EQ(told.exit_code, 1);
  EXPECT_TRUE(contains(told, "leak: heap.main-1 is lost: 4 bytes, allocated at keeper.cpp:4")) << told.output;
}

TEST_F(ProcessesTest, that_are_services_are_stopped_also_when_they_are_just_started_again) {
  build_image("emulator", std::string{mailbox} + emulator);
  build_image("short", "int main() {}");
  const Result result = ltsim(
      "explore --executions 100 --service ./emulator.so --process ./short.so --crash emulator:5 "
      "--within 10 --keep-going");
  // Its server waits for a question that nobody asks.
  EXPECT_TRUE(contains(result.output, "emulator@2/main waits in thread_join")) << result.output;
  EXPECT_FALSE(contains(result.output, "after 10 s")) << result.output;
  build_image("sleeper", R"(
    #include <unistd.h>
    int main() { sleep(100); })");
  const Result late = ltsim("explore --process ./sleeper.so --within 10");
  EXPECT_EQ(late.exit_code, 1);
  EXPECT_TRUE(contains(late.output, "invariant: after 10 s there are still sleeper")) << late.output;
}

TEST_F(ProcessesTest, that_are_killed_let_go_of_the_locks_of_their_files) {
  build_image("keeper", R"(
    #include <fcntl.h>
    #include <unistd.h>
    int main() {
      const int file = open("lock", O_RDWR | O_CREAT, 0600);
      if (file > 60) return 4;  // those of earlier executions are still open
      struct flock whole = {};
      whole.l_type = F_WRLCK;
      if (fcntl(file, F_OFD_SETLK, &whole) != 0) return 5;
      usleep(1000);
      return 0;
    })");
  const Result alone = ltsim("explore --executions 200 --process ./keeper.so --crash keeper:1 --keep-going");
  EXPECT_EQ(alone.exit_code, 0) << alone.output;
  const Result two =
      ltsim("explore --executions 200 --exit-status 0,4 --process ./keeper.so --process ./keeper.so");
  EXPECT_EQ(two.exit_code, 1);
  EXPECT_TRUE(contains(two.output, "exit: keeper-2 ended with status 5")) << two.output;
}

TEST_F(ProcessesTest, send_each_other_signals) {
  build_image("waiter", R"(
    #include <signal.h>
    #include <stdio.h>
    #include <time.h>
    int main() {
      sigset_t set;
      sigemptyset(&set);
      sigaddset(&set, SIGUSR1);
      sigprocmask(SIG_BLOCK, &set, nullptr);
      const timespec pause{.tv_sec = 5, .tv_nsec = 0};
      siginfo_t told;
      const int signal = sigtimedwait(&set, &told, &pause);
      if (signal == -1) return 4;
      printf("got %d\n", told.si_signo);
      return signal == SIGUSR1 ? 0 : 5;
    })");
  build_image("sender", R"(
    #include <errno.h>
    #include <signal.h>
    #include <unistd.h>
    int main() {
      if (kill(1234, SIGUSR1) != -1 || errno != ESRCH) return 6;
      if (kill(getpid(), 0) != 0) return 7;
      kill(getpid() - 1, SIGUSR1);
      return 0;
    })");
  const Result once = run_once("waiter+sender", R"(argument  "--process=./waiter.so"
argument  "--process=./sender.so"
)");
  EXPECT_EQ(once.exit_code, 0) << once.output;
  EXPECT_TRUE(contains(once.output, "got 10\n")) << once.output;
  // Before the waiter has blocked the signal it ends by it; that is no failure of its own. When it is slow to come it may not wait so
  // long.
  const Result result =
      ltsim("explore --executions 300 --keep-going --process ./waiter.so --process ./sender.so");
  EXPECT_EQ(result.exit_code, 1) << result.output;
  EXPECT_TRUE(contains(result.output, "exit: waiter ended with status 4")) << result.output;
  EXPECT_FALSE(contains(result.output, "status 5")) << result.output;
}

TEST_F(ProcessesTest, find_and_replay_what_a_file_of_the_schedule_says) {
  build_image("kernel", std::string{mailbox} + R"(
    int main() {
      Mailbox* const box = attach();
      box->request = 1;
      sem_post(asked);
      box->request = 2;
      return 0;
    })");
  build_image("emulator", std::string{mailbox} + R"(
    int main() {
      const Mailbox* const box = attach();
      sem_wait(asked);
      return box->request == 1 ? 0 : 9;
    })");
  const Result found = ltsim("explore --process ./emulator.so --process ./kernel.so");
  EXPECT_EQ(found.exit_code, 1);
  const Result replayed = ltsim("replay out/emulator+kernel.schedule");
  EXPECT_EQ(replayed.exit_code, 1);
  EXPECT_FALSE(contains(replayed.output, "not as recorded")) << replayed.output;
  EXPECT_TRUE(contains(read("out/emulator+kernel.schedule"), "program   \"ltsim-processes\"\n"))
      << found.output;
  const Result proved = ltsim("prove --process ./emulator.so --process ./kernel.so");
  EXPECT_EQ(proved.exit_code, 1);
  EXPECT_TRUE(contains(proved.output, "emulator+kernel")) << proved.output;
}

TEST_F(ProcessesTest, are_refused_with_the_reason) {
  build_image("kernel", std::string{mailbox} + kernel);
  write("text.so", "no image\n");
  const auto refusal = [&](const std::string& arguments) {
    const Result result = ltsim("explore " + arguments);
    EXPECT_EQ(result.exit_code, 2) << result.output;
    return result.output;
  };
  EXPECT_EQ(refusal("--process ./missing.so"), "ltsim: ./missing.so: No such file or directory\n");
  EXPECT_EQ(refusal("--process ./text.so"),
            "ltsim: ./text.so: is no program: a script cannot be looked into\n");
  EXPECT_EQ(refusal("--process /lib/x86_64-linux-gnu/libm.so.6"),
            "ltsim: /lib/x86_64-linux-gnu/libm.so.6: was not built with ltsim-cc or ltsim-c++ --process\n");
  EXPECT_EQ(refusal("--process ./kernel.so --crash kern"),
            "ltsim: there is no process \"kern\"; there are kernel\n");
  EXPECT_EQ(refusal("--process ./kernel.so --crash kernel:soon"),
            "ltsim: --crash kernel:soon: \"soon\" is no number of milliseconds\n");
  EXPECT_EQ(refusal("--service ./kernel.so"), "ltsim: no --process: a world of services never ends\n");
  EXPECT_TRUE(contains(refusal("--process ./kernel.so --fault rain"),
                       "there is no fault \"rain\"; there are lost-post"));
  const Result alone = shell(LTSIM_PROCESSES);
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_EQ(alone.output, "ltsim-processes: is run by ltsim: ltsim explore --process IMAGE:ARGUMENTS ...\n");
}

/// Of ltsim-processes: this project's own programs, unmodified, with a PLC program and a part program that are short.
/// @param common  arguments for both of them
/// @param kernel  arguments for the kernel alone
std::string both_sides(const std::string& common, const std::string& kernel_alone) {
  const std::string segment = "--segment ltsim-processes-test ";
  return std::string{"--service \"" IMAGES_FOLDER "/plc-emulator.so:"} + segment + common +
         " --program " SOURCES_FOLDER "/emulator_models/programs/acknowledge.il\" --process \"" IMAGES_FOLDER
         "/cnc-kernel.so:" +
         segment + common + " " + kernel_alone +
         " " SOURCES_FOLDER "/kernel_mocks/programs/two_functions.nc\"";
}

TEST_F(ProcessesTest, of_the_kernel_and_the_emulator_exchange_unmodified) {
  const Result result = ltsim("explore --executions 1 --strategy random --steady " + both_sides("", ""));
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

TEST_F(ProcessesTest, of_the_kernel_and_the_emulator_hang_by_the_published_handoff_alone_when_one_is_killed) {
  const std::string explore =
      "explore --executions 30 --minimize-seconds 0 --steady --within 5 --points 10000000 --crash "
      "plc-emulator:20 "
      "--exit-status 0,1 ";
  const std::string patient = "--read-timeout-ms 3600000 --fin-timeout-ms 1000";
  const Result paper = ltsim(explore + both_sides("--protocol paper", patient));
  EXPECT_EQ(paper.exit_code, 1);
  EXPECT_TRUE(contains(paper.output, "after 5 s there are still plc-emulator, cnc-kernel")) << paper.output;
  const Result hardened = ltsim(explore + both_sides("", patient));
  EXPECT_EQ(hardened.exit_code, 0) << hardened.output;
}

}  // namespace
