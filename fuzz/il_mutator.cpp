#include "fuzz/il_mutator.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/text_input.hpp"
#include "sim_clock/explore/random_generator.hpp"

namespace fuzz {
namespace {

constexpr std::array<std::string_view, 47> operators{
    "LD",   "LDN",  "ST",    "STN", "S",    "R",   "NOT",   "AND", "ANDN", "OR",    "ORN", "XOR",
    "XORN", "AND(", "ANDN(", "OR(", "XOR(", "ADD", "SUB",   "MUL", "DIV",  "MOD",   "GT",  "GE",
    "EQ",   "NE",   "LE",    "LT",  "ADD(", "EQ(", ")",     "JMP", "JMPC", "JMPCN", "CAL", "CALC",
    "RET",  "RETC", "RETCN", "ABS", "MIN",  "MAX", "LIMIT", "SEL", "SHL",  "SHR",   "ROL"};

/// Of each type one of the usual and those at its bounds.
constexpr std::array<std::string_view, 66> operands{"TRUE",
                                                    "FALSE",
                                                    "BOOL#1",
                                                    "0",
                                                    "1",
                                                    "-1",
                                                    "2",
                                                    "5",
                                                    "63",
                                                    "64",
                                                    "65",
                                                    "127",
                                                    "-128",
                                                    "SINT#-128",
                                                    "INT#-32768",
                                                    "32767",
                                                    "DINT#-2147483648",
                                                    "LINT#-9223372036854775808",
                                                    "9223372036854775807",
                                                    "USINT#255",
                                                    "UINT#65535",
                                                    "UDINT#4294967295",
                                                    "ULINT#18446744073709551615",
                                                    "16#FF",
                                                    "2#1010_1010",
                                                    "8#17",
                                                    "BYTE#16#FF",
                                                    "WORD#16#8000",
                                                    "DWORD#16#80000000",
                                                    "LWORD#16#FFFFFFFFFFFFFFFF",
                                                    "0.0",
                                                    "1.5",
                                                    "-1.0E38",
                                                    "REAL#3.4E38",
                                                    "LREAL#1.0E308",
                                                    "LREAL#-0.0",
                                                    "T#0s",
                                                    "T#5ms",
                                                    "T#-1d2h3m4s5ms",
                                                    "T#292y",
                                                    "T#106751d",
                                                    "%IX0.0",
                                                    "%IX31.7",
                                                    "%IB0",
                                                    "%IW1",
                                                    "%QX0.1",
                                                    "%QB0",
                                                    "%QW0",
                                                    "%MX0.0",
                                                    "%MB1",
                                                    "%MW0",
                                                    "%MD1",
                                                    "%ML1",
                                                    "X0",
                                                    "X7",
                                                    "Y10",
                                                    "M0",
                                                    "M8000",
                                                    "S1",
                                                    "D0",
                                                    "D8000",
                                                    "D7999",
                                                    "T5.Q",
                                                    "C5.CV",
                                                    "a",
                                                    "t.Q"};

constexpr std::array<std::string_view, 16> types{"BOOL",  "SINT",  "INT",   "DINT", "LINT", "USINT",
                                                 "UINT",  "UDINT", "ULINT", "BYTE", "WORD", "DWORD",
                                                 "LWORD", "REAL",  "LREAL", "TIME"};

constexpr std::array<std::string_view, 25> new_lines{"LD TRUE",
                                                     "LD 1",
                                                     "LD 1.5",
                                                     "LD T#1s",
                                                     "ST a",
                                                     "S b",
                                                     "R b",
                                                     "l: LD a",
                                                     "JMP l",
                                                     "JMPC l",
                                                     "CAL t(IN := a, PT := T#1s)",
                                                     "CAL c(CU := a, PV := 3)",
                                                     "CAL T5(IN := X0, PV := 50)",
                                                     "CAL C5(CU := X0, PV := 3)",
                                                     "AND( a",
                                                     "OR(",
                                                     ")",
                                                     "MAX 1, 2, 3",
                                                     "LIMIT(MN := 0, IN := 5, MX := 3)",
                                                     "SEL(G := TRUE, IN0 := 1, IN1 := 2)",
                                                     "VAR a AT %MW0 : INT := 5; END_VAR",
                                                     "VAR b : BOOL; t : TON; c : CTU; e : R_TRIG; END_VAR",
                                                     "VAR RETAIN a : DINT := -1; END_VAR",
                                                     "VAR_INPUT a : REAL; END_VAR",
                                                     "VAR CONSTANT k : LINT := 16#7FFFFFFFFFFFFFFF; END_VAR"};

bool is_word(char c) { return c > ' ' && c != ',' && c != ';' && c != '(' && c != ')'; }

struct Piece {
  std::size_t begin;
  std::size_t length;
};

/// Operators, names, literals, addresses of a line.
std::vector<Piece> words_of(std::string_view line) {
  std::vector<Piece> words;
  for (std::size_t at = 0; at < line.size(); ++at) {
    if (!is_word(line[at])) continue;
    if (at == 0 || !is_word(line[at - 1])) words.push_back({at, 0});
    ++words.back().length;
  }
  return words;
}

class Mutation {
 public:
  Mutation(std::string_view source, unsigned seed) : random_{seed} {
    for (const std::string_view line : ltsim::lines_as_records(source)) lines_.emplace_back(line);
    if (lines_.empty()) lines_.emplace_back("PROGRAM p\n");
  }

  std::string run() {
    for (auto count = 1 + random_.below(4); count > 0; --count) change();
    std::string text;
    for (const std::string& line : lines_) text += line;
    return text;
  }

 private:
  void change() {
    const std::size_t at = any_line();
    switch (random_.below(9)) {
      case 0:
        std::swap(lines_[at], lines_[any_line()]);
        break;
      case 1:
        insert(lines_[any_line()]);
        break;
      case 2:
        if (lines_.size() > 1) lines_.erase(lines_.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      case 3:
        insert(std::string{any_of(new_lines)} + "\n");
        break;
      case 4:
        insert(std::string{any_of(operators)} + " " + std::string{any_word()} + "\n");
        break;
      case 5:
        replace_word(lines_[at], std::string{any_of(operators)});
        break;
      case 6:
        replace_word(lines_[at], std::string{any_of(types)});
        break;
      case 7:
        replace_word(lines_[at], std::string{any_of(types)} + "_TO_" + std::string{any_of(types)});
        break;
      default:
        replace_word(lines_[at], any_word());
    }
  }

  template <typename Words>
  std::string_view any_of(const Words& words) {
    return words[random_.below(static_cast<std::uint32_t>(words.size()))];
  }
  std::size_t any_line() { return random_.below(static_cast<std::uint32_t>(lines_.size())); }

  /// Of the language, or of this source.
  std::string any_word() {
    const std::string& line = lines_[any_line()];
    const std::vector<Piece> words = words_of(line);
    if (words.empty() || random_.below(2) == 0) return std::string{any_of(operands)};
    const Piece word = words[random_.below(static_cast<std::uint32_t>(words.size()))];
    return line.substr(word.begin, word.length);
  }

  void replace_word(std::string& line, const std::string& by) {
    const std::vector<Piece> words = words_of(line);
    if (words.empty()) return;
    const Piece word = words[random_.below(static_cast<std::uint32_t>(words.size()))];
    line.replace(word.begin, word.length, by);
  }

  void insert(std::string line) {
    lines_.insert(lines_.begin() + static_cast<std::ptrdiff_t>(any_line()), std::move(line));
  }

  std::vector<std::string> lines_;
  ltsim::RandomGenerator random_;
};

}  // namespace

std::size_t mutate_instruction_list(std::span<std::byte> data, std::size_t size, unsigned seed,
                                    ltsim::PlainMutator plain) {
  constexpr unsigned plain_every = 4;
  if (seed % plain_every == 0) return plain(data, size);
  const std::string text = Mutation{text_of(data.first(size)), seed}.run();
  const std::size_t length = std::min(text.size(), data.size());
  std::memcpy(data.data(), text.data(), length);
  return length;
}

}  // namespace fuzz
