#include "sim_clock/check/program_symbols.hpp"

#include <cxxabi.h>
#include <fcntl.h>
#include <gelf.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <tuple>
#include <vector>

#include "sim_clock/world/object_names.hpp"
#include "sim_clock/world/program_image.hpp"
#include "sim_clock/world/task.hpp"

namespace ltsim {
namespace {

std::string readable(const char* name) {
  int status = 0;
  const std::unique_ptr<char, decltype(&std::free)> demangled{
      abi::__cxa_demangle(name, nullptr, nullptr, &status), &std::free};
  std::string text = status == 0 ? demangled.get() : name;
  make_one_word(text);
  return text;
}

/// Of one image.
class ImageSymbols {
 public:
  explicit ImageSymbols(std::size_t image) : image_(image) {
    elf_version(EV_CURRENT);
    const int file = open(ProgramImage::file(image).path, O_RDONLY | O_CLOEXEC);
    if (file < 0) return;
    if (Elf* const elf = elf_begin(file, ELF_C_READ, nullptr); elf != nullptr) {
      read_tables(elf);
      elf_end(elf);
    }
    close(file);
    std::sort(symbols_.begin(), symbols_.end(), [](const ProgramSymbol& a, const ProgramSymbol& b) {
      return std::tie(a.offset, a.name) < std::tie(b.offset, b.name);
    });
  }

  [[nodiscard]] const ProgramSymbol& at(std::uint32_t offset) const {
    auto next = std::upper_bound(
        symbols_.begin(), symbols_.end(), offset,
        [](std::uint32_t wanted, const ProgramSymbol& each) { return wanted < each.offset; });
    if (next == symbols_.begin()) return all_;
    --next;
    return offset - next->offset < next->bytes ? *next : all_;
  }

 private:
  void read_tables(Elf* elf) {
    for (Elf_Scn* section = nullptr; (section = elf_nextscn(elf, section)) != nullptr;) {
      GElf_Shdr header;
      if (gelf_getshdr(section, &header) == nullptr || header.sh_type != SHT_SYMTAB || header.sh_entsize == 0)
        continue;
      Elf_Data* const data = elf_getdata(section, nullptr);
      for (std::size_t i = 0; data != nullptr && i < header.sh_size / header.sh_entsize; ++i) {
        GElf_Sym symbol;
        if (gelf_getsym(data, static_cast<int>(i), &symbol) != nullptr) add(elf, header.sh_link, symbol);
      }
    }
  }

  void add(Elf* elf, std::size_t names, const GElf_Sym& symbol) {
    if (GELF_ST_TYPE(symbol.st_info) != STT_OBJECT || symbol.st_size == 0) return;
    const std::uintptr_t address = ProgramImage::file(image_).loaded_at + symbol.st_value;
    const std::uint32_t offset = ProgramImage::variable_at(reinterpret_cast<const void*>(address));
    if (offset == ProgramImage::no_variable) return;
    const char* const name = elf_strptr(elf, names, symbol.st_name);
    if (name == nullptr) return;
    symbols_.push_back(
        {.name = readable(name), .offset = offset, .bytes = static_cast<std::uint32_t>(symbol.st_size)});
  }

  std::size_t image_;
  std::vector<ProgramSymbol> symbols_;  // by offset
  ProgramSymbol all_{.name = "variables",
                     .offset = ProgramImage::first_variable(image_),
                     .bytes = static_cast<std::uint32_t>(ProgramImage::variables(image_).size())};
};

const ImageSymbols& symbols_of(std::size_t image) {
  const GhostScope ghost;  // the file is the host's, and so is what the exit of this process has to destroy
  static std::array<std::unique_ptr<ImageSymbols>, ProgramImage::images_max> symbols;
  if (symbols[image] == nullptr) symbols[image] = std::make_unique<ImageSymbols>(image);
  return *symbols[image];
}

}  // namespace

const ProgramSymbol& symbol_at(std::uint32_t offset) {
  return symbols_of(ProgramImage::image_of_variable(offset)).at(offset);
}

void read_symbols() {
  for (std::size_t image = 0; image < ProgramImage::count(); ++image) static_cast<void>(symbols_of(image));
}

}  // namespace ltsim
