#include "sim_clock/program/output_capture.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "sim_clock/check/own_descriptor.hpp"
#include "sim_clock/check/self_check.hpp"

namespace ltsim {

OutputCapture::OutputCapture()
    : file_(as_own_descriptor(memfd_create("ltsim-output", MFD_CLOEXEC))),
      out_(fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, own_descriptors_begin)),
      error_(fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, own_descriptors_begin)) {
  LTSIM_CHECK(file_ >= 0 && fcntl(file_, F_SETFL, O_APPEND) == 0);
}

OutputCapture::~OutputCapture() {
  close(file_);
  close(out_);
  close(error_);
}

void OutputCapture::begin() {
  std::fflush(stdout);
  dup2(file_, STDOUT_FILENO);
  dup2(file_, STDERR_FILENO);
}

std::string OutputCapture::end() {
  std::fflush(stdout);
  if (out_ >= 0) dup2(out_, STDOUT_FILENO);
  if (error_ >= 0) dup2(error_, STDERR_FILENO);
  std::string text;
  const off_t bytes = lseek(file_, 0, SEEK_END);
  if (bytes <= 0) return text;
  text.resize(std::min(static_cast<std::size_t>(bytes), bytes_max));
  const ssize_t got = pread(file_, text.data(), text.size(), 0);
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  LTSIM_CHECK(ftruncate(file_, 0) == 0);
  return text;
}

}  // namespace ltsim
