#include "sim_clock/world/program_image.hpp"

#include <elf.h>
#include <link.h>

namespace ltsim {
namespace {

constexpr std::size_t page_bytes = 4096;

/// Before the constructors of the program's own objects.
[[gnu::constructor(101)]] void find_program() { ProgramImage::add_program(); }

/// A module of the process, and which one is wanted.
struct Wanted {
  const void* inside = nullptr;  // null: the first that the linker lists, which is the program
  dl_phdr_info module{};
  bool is_found = false;
};

int note_wanted(dl_phdr_info* module, std::size_t /*size*/, void* into) {
  auto& wanted = *static_cast<Wanted*>(into);
  const std::span headers{module->dlpi_phdr, module->dlpi_phnum};
  const auto is_inside = [&](const ElfW(Phdr) & header) {
    return header.p_type == PT_LOAD &&
           reinterpret_cast<std::uintptr_t>(wanted.inside) - module->dlpi_addr - header.p_vaddr <
               header.p_memsz;
  };
  if (wanted.inside != nullptr && std::none_of(headers.begin(), headers.end(), is_inside)) return 0;
  wanted.module = *module;
  wanted.is_found = true;
  return 1;
}

}  // namespace

void ProgramImage::add_program() {
  Wanted program;
  dl_iterate_phdr(&note_wanted, &program);
  add(program.module, "/proc/self/exe");
}

void ProgramImage::add_expected(const void* inside) {
  Wanted image{.inside = inside};
  dl_iterate_phdr(&note_wanted, &image);
  if (image.is_found) add(image.module, expected_);
  expected_ = nullptr;
}

void ProgramImage::add(const dl_phdr_info& module, const char* path) {
  std::uintptr_t begin = ~std::uintptr_t{0};
  std::uintptr_t end = 0;
  std::uintptr_t code_end = 0;
  std::uintptr_t constants_end = 0;  // of what is written by the loader alone
  std::uintptr_t variables_begin = 0;
  std::uintptr_t variables_end = 0;
  for (const auto& header : std::span{module.dlpi_phdr, module.dlpi_phnum}) {
    const std::uintptr_t at = module.dlpi_addr + header.p_vaddr;
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
  variables_begin = std::clamp(constants_end, variables_begin, variables_end);
  const Image* const last = count_ == 0 ? nullptr : &images_[count_ - 1];
  const auto up_to_page = [](std::size_t bytes) {
    return static_cast<std::uint32_t>((bytes + page_bytes - 1) / page_bytes * page_bytes);
  };
  images_[count_] = {
      .begin = begin,
      .bytes = end - begin,
      .code_bytes = code_end - begin,
      .variables_begin = variables_begin,
      .variables_bytes = variables_end - variables_begin,
      .sites_begin = last == nullptr ? 0 : last->sites_begin + up_to_page(last->bytes),
      .first_variable = last == nullptr ? 0 : last->first_variable + up_to_page(last->variables_bytes)};
  files_[count_] = {.path = path, .loaded_at = module.dlpi_addr};
  ++count_;
}

ProgramImage::Site ProgramImage::find_site(std::uint32_t site) noexcept {
  std::size_t index = count_ - 1;
  while (index != 0 && site < images_[index].sites_begin) --index;
  const Image& image = images_[index];
  return {.image = index,
          .linked_address = image.begin + (site - image.sites_begin) - files_[index].loaded_at};
}

std::size_t ProgramImage::image_of_variable(std::uint32_t place) noexcept {
  std::size_t index = count_ - 1;
  while (index != 0 && place < images_[index].first_variable) --index;
  return index;
}

}  // namespace ltsim
