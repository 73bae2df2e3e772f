// A serial line of the system, tried on a pseudo-terminal: the test holds the other end.

#include <array>
#include <csignal>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include <fcntl.h>
#include <pty.h>
#include <sys/file.h>
#include <termios.h>
#include <unistd.h>

#include "protocol/posix_port_manager.hpp"
#include "protocol/posix_serial_port.hpp"
#include "tests/protocol/test_segment.hpp"

namespace protocol {
namespace {

using namespace std::chrono_literals;

/// A pseudo-terminal; the far end is what would be the PLC's.
class PseudoTerminal {
 public:
  PseudoTerminal() {
    std::array<char, 128> path{};
    int line = -1;
    if (::openpty(&far_end_, &line, path.data(), nullptr, nullptr) != 0) std::abort();
    path_ = path.data();
    line_ = line;  // kept open: the far end hangs up when nobody has the line open
  }
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;
  ~PseudoTerminal() {
    hang_up();
    ::close(line_);
  }

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  [[nodiscard]] int line() const noexcept { return line_; }

  void send(std::string_view text) const {
    EXPECT_EQ(::write(far_end_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  [[nodiscard]] std::string receive(std::size_t bytes_count) const {
    std::string text(bytes_count, '\0');
    std::size_t received = 0;
    while (received < bytes_count) {
      const ssize_t count = ::read(far_end_, text.data() + received, bytes_count - received);
      if (count <= 0) break;
      received += static_cast<std::size_t>(count);
    }
    return text.substr(0, received);
  }
  void hang_up() {
    if (far_end_ >= 0) ::close(std::exchange(far_end_, -1));
  }

 private:
  int far_end_ = -1;
  int line_ = -1;
  std::string path_;
};

class PosixSerialPortTest : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(port_.open()); }

  /// Reads until all bytes are there, the read time-out passes or an error comes.
  std::string read(std::size_t bytes_count) {
    std::string received;
    while (received.size() < bytes_count) {
      std::vector<std::byte> buffer(bytes_count - received.size());
      const auto count = port_.read(buffer);
      if (!count || *count == 0) break;
      received += text(std::span(buffer).first(*count));
    }
    return received;
  }

  PseudoTerminal terminal_;
  PosixSerialPort port_{terminal_.path()};
};

TEST_F(PosixSerialPortTest, sends_and_receives_every_byte_value_unchanged) {
  std::string all;
  for (int value = 0; value < 256; ++value) all += static_cast<char>(value);
  port_.set_timeouts({.read = 10s, .write = 10s});
  EXPECT_EQ(port_.write(bytes(all)), 256u);
  EXPECT_EQ(terminal_.receive(256), all);
  terminal_.send(all);
  EXPECT_EQ(read(256), all);
}

TEST_F(PosixSerialPortTest, gives_an_answer_in_pieces_to_a_reader_of_pieces) {
  port_.set_timeouts({.read = 10s, .write = 10s});
  terminal_.send("answer");
  EXPECT_EQ(read(1), "a");
  EXPECT_EQ(read(5), "nswer");
}

TEST_F(PosixSerialPortTest, a_time_out_is_zero_bytes_and_is_never_early) {
  port_.set_timeouts({.read = 20ms, .write = 0ns});
  std::array<std::byte, 8> buffer{};
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(port_.read(buffer), 0u);
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 20ms);
}

TEST_F(PosixSerialPortTest, a_read_time_out_of_zero_takes_what_is_there) {
  terminal_.send("x");
  port_.set_timeouts({.read = 10s, .write = 0ns});
  EXPECT_EQ(read(1), "x");
  port_.set_timeouts({.read = 0ns, .write = 0ns});
  EXPECT_EQ(read(1), "");
}

TEST_F(PosixSerialPortTest, a_write_that_the_line_does_not_take_ends_at_its_time_out) {
  port_.set_timeouts({.read = 0ns, .write = 1ms});
  const std::vector<std::byte> more_than_fits(1 << 20);
  const auto written = port_.write(more_than_fits);
  ASSERT_TRUE(written);
  EXPECT_LT(*written, more_than_fits.size());
}

TEST_F(PosixSerialPortTest, purging_forgets_what_was_received) {
  port_.set_timeouts({.read = 10s, .write = 0ns});
  terminal_.send("ab");
  EXPECT_EQ(read(1), "a");
  port_.purge();
  port_.set_timeouts({.read = 0ns, .write = 0ns});
  EXPECT_EQ(read(1), "");
}

TEST_F(PosixSerialPortTest, a_line_that_hangs_up_is_lost) {
  port_.set_timeouts({.read = 10s, .write = 10s});
  terminal_.hang_up();
  std::array<std::byte, 8> buffer{};
  EXPECT_EQ(port_.read(buffer), tl::make_unexpected(PortError::line_lost));
  EXPECT_EQ(port_.write(bytes("ask")), tl::make_unexpected(PortError::line_lost));
}

TEST_F(PosixSerialPortTest, is_an_error_to_use_once_closed) {
  port_.close();
  port_.close();
  EXPECT_FALSE(port_.is_open());
  std::array<std::byte, 8> buffer{};
  EXPECT_EQ(port_.read(buffer), tl::make_unexpected(PortError::not_open));
  EXPECT_EQ(port_.write(bytes("ask")), tl::make_unexpected(PortError::not_open));
  EXPECT_TRUE(port_.open());
}

TEST_F(PosixSerialPortTest, does_not_share_a_line_that_is_in_use) {
  PosixSerialPort second(terminal_.path());
  EXPECT_EQ(second.open(), tl::make_unexpected(PortError::already_in_use));
  port_.close();
  EXPECT_TRUE(second.open());
}

TEST_F(PosixSerialPortTest, sets_a_pseudo_terminal_to_8n1_although_7e1_was_asked_for) {
  termios line = {};
  ASSERT_EQ(::tcgetattr(terminal_.line(), &line), 0);
  EXPECT_EQ(line.c_cflag & CSIZE, static_cast<tcflag_t>(CS8));
  EXPECT_EQ(line.c_cflag & PARENB, 0u);
  EXPECT_EQ(line.c_lflag & (ECHO | ICANON | ISIG), 0u);
  EXPECT_EQ(::cfgetospeed(&line), static_cast<speed_t>(B9600));
}

TEST(PosixSerialPort, sets_the_baud_rate_asked_for) {
  const PseudoTerminal terminal;
  PosixSerialPort port(terminal.path(), {.baud_rate = 38400});
  ASSERT_TRUE(port.open());
  termios line = {};
  ASSERT_EQ(::tcgetattr(terminal.line(), &line), 0);
  EXPECT_EQ(::cfgetospeed(&line), static_cast<speed_t>(B38400));
}

TEST(PosixSerialPort, refuses_what_is_no_line_or_cannot_be_set) {
  EXPECT_EQ(PosixSerialPort("/dev/no-such-tty").open(), tl::make_unexpected(PortError::cannot_open));
  EXPECT_EQ(PosixSerialPort("/dev/null").open(), tl::make_unexpected(PortError::cannot_open));
  const PseudoTerminal terminal;
  EXPECT_EQ(PosixSerialPort(terminal.path(), {.baud_rate = 12345}).open(),
            tl::make_unexpected(PortError::cannot_open));
}

TEST(PosixSerialPort, a_signal_does_not_end_a_read) {
  const PseudoTerminal terminal;
  PosixSerialPort port(terminal.path());
  ASSERT_TRUE(port.open());
  port.set_timeouts({.read = 10s, .write = 10s});
  struct sigaction ignore_but_interrupt = {};
  ignore_but_interrupt.sa_handler = [](int) {};
  struct sigaction former = {};
  ASSERT_EQ(::sigaction(SIGUSR1, &ignore_but_interrupt, &former), 0);
  std::jthread far_end([&terminal, reader = ::pthread_self()] {
    for (int i = 0; i < 20; ++i) {
      ::pthread_kill(reader, SIGUSR1);
      std::this_thread::sleep_for(1ms);
    }
    terminal.send("x");
  });
  std::array<std::byte, 1> buffer{};
  EXPECT_EQ(port.read(buffer), 1u);
  far_end.join();
  ::sigaction(SIGUSR1, &former, nullptr);
}

TEST(PosixPortManager, hands_out_one_port_for_each_device) {
  const PseudoTerminal terminal;
  PosixPortManager ports;
  const auto port = ports.port(terminal.path());
  ASSERT_TRUE(port);
  EXPECT_FALSE((*port)->is_open());
  EXPECT_TRUE((*port)->open());
  EXPECT_EQ(*ports.port(terminal.path()), *port);
  EXPECT_NE(*ports.port("/dev/null"), *port);
}

}  // namespace
}  // namespace protocol
