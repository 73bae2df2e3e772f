#include "sim_clock/program/open_descriptors.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <iterator>
#include <string>

#include "sim_clock/check/own_descriptor.hpp"

namespace ltsim {

OpenDescriptors::OpenDescriptors()
    : kept_(open_now()),
      input_(fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, own_descriptors_begin)),
      input_begin_(lseek(STDIN_FILENO, 0, SEEK_CUR)) {}

OpenDescriptors::~OpenDescriptors() {
  if (input_ >= 0) close(input_);
}

std::vector<int> OpenDescriptors::open_now() {
  std::vector<int> open;
  for (const auto& entry : std::filesystem::directory_iterator{"/proc/self/fd"}) {
    const std::string name = entry.path().filename().string();
    int number = own_descriptors_begin;
    std::from_chars(name.data(), name.data() + name.size(), number);
    if (number < own_descriptors_begin) open.push_back(number);
  }
  // That of the folder itself is closed again.
  std::erase_if(open, [](int number) { return fcntl(number, F_GETFD) < 0; });
  std::sort(open.begin(), open.end());
  return open;
}

std::vector<int> OpenDescriptors::left_open() const {
  const std::vector<int> now = open_now();
  std::vector<int> left;
  std::set_difference(now.begin(), now.end(), kept_.begin(), kept_.end(), std::back_inserter(left));
  return left;
}

void OpenDescriptors::close_left_open() const noexcept {
  int begin = 0;
  for (const int kept : kept_) {
    if (begin < kept) close_range(static_cast<unsigned>(begin), static_cast<unsigned>(kept - 1), 0);
    begin = kept + 1;
  }
  close_range(static_cast<unsigned>(begin), own_descriptors_begin - 1, 0);
}

void OpenDescriptors::rewind_input() const noexcept {
  if (input_ < 0) return;
  if (fcntl(STDIN_FILENO, F_GETFD) < 0) dup2(input_, STDIN_FILENO);
  if (input_begin_ >= 0 && lseek(STDIN_FILENO, 0, SEEK_CUR) != input_begin_)
    lseek(STDIN_FILENO, input_begin_, SEEK_SET);
}

}  // namespace ltsim
