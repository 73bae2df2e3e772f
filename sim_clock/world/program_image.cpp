#include "sim_clock/world/program_image.hpp"

#include <elf.h>
#include <link.h>

#include <algorithm>

namespace ltsim {
namespace {

/// The first that the linker lists is the program; it stops there.
int note_first(dl_phdr_info* program, std::size_t /*size*/, void* into) {
  *static_cast<dl_phdr_info*>(into) = *program;
  return 1;
}

constexpr std::size_t page_bytes = 4096;

/// Before the constructors of the program's own objects.
[[gnu::constructor(101)]] void find_image() { ProgramImage::find(); }

}  // namespace

void ProgramImage::find() noexcept {
  dl_phdr_info program{};
  dl_iterate_phdr(&note_first, &program);
  std::uintptr_t begin = ~std::uintptr_t{0};
  std::uintptr_t end = 0;
  std::uintptr_t code_end = 0;
  std::uintptr_t constants_end = 0;  // of what is written by the loader alone
  std::uintptr_t variables_begin = 0;
  std::uintptr_t variables_end = 0;
  for (int i = 0; i < program.dlpi_phnum; ++i) {
    const auto& header = program.dlpi_phdr[i];
    const std::uintptr_t at = program.dlpi_addr + header.p_vaddr;
    if (header.p_type == PT_GNU_RELRO) constants_end = (at + header.p_memsz) / page_bytes * page_bytes;
    if (header.p_type != PT_LOAD) continue;
    begin = std::min(begin, at);
    end = std::max(end, at + header.p_memsz);
    if ((header.p_flags & PF_X) != 0) code_end = std::max(code_end, at + header.p_memsz);
    if ((header.p_flags & PF_W) == 0) continue;
    // Of GNU ld it is one segment with the constants at its begin; LLVM's lld makes two.
    variables_begin = at;
    variables_end = std::max(variables_end, at + header.p_memsz);
  }
  begin_ = begin;
  bytes_ = end - begin;
  code_bytes_ = code_end - begin;
  loaded_at_ = program.dlpi_addr;
  variables_begin_ = std::clamp(constants_end, variables_begin, variables_end);
  variables_bytes_ = variables_end - variables_begin_;
}

}  // namespace ltsim
