#include "emulator_models/soft_plc/il_literal.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "emulator_models/soft_plc/il_lexer.hpp"

namespace emulator_models::soft_plc {
namespace {

using Parsed = tl::expected<Literal, std::string>;

tl::unexpected<std::string> wrong(std::string message) { return tl::unexpected(std::move(message)); }

bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

int digit_value(char c) noexcept {
  if (is_digit(c)) return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// Takes the underscores away, each of which must stand between two digits.
tl::expected<std::string, std::string> without_underscores(std::string_view text) {
  std::string digits;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '_') {
      digits += text[i];
      continue;
    }
    const bool between =
        i > 0 && i + 1 < text.size() && digit_value(text[i - 1]) >= 0 && digit_value(text[i + 1]) >= 0;
    if (!between) return wrong("an underscore stands alone between two digits: 1_000");
  }
  return digits;
}

bool take_sign(std::string_view& text) noexcept {
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  return negative;
}

Parsed parse_digits(std::string_view digits, unsigned base, bool negative) {
  if (digits.empty()) return wrong("digits are missing");
  Literal literal;
  literal.negative = negative;
  for (const char c : digits) {
    const int digit = digit_value(c);
    if (digit < 0 || static_cast<unsigned>(digit) >= base)
      return wrong(std::string{"'"} + c + "' is no digit of base " + std::to_string(base));
    if (__builtin_mul_overflow(literal.magnitude, base, &literal.magnitude) ||
        __builtin_add_overflow(literal.magnitude, static_cast<unsigned>(digit), &literal.magnitude))
      return wrong("the number does not fit 64 bits");
  }
  return literal;
}

Parsed parse_real(const std::string& digits, bool negative) {
  double value = 0.0;
  const char* const end = digits.data() + digits.size();
  const auto [stopped, error] = std::from_chars(digits.data(), end, value);
  if (error == std::errc::result_out_of_range) return wrong("the number is out of the range of LREAL");
  const std::size_t dot = digits.find('.');
  const bool digits_around_dot = dot != std::string::npos && dot > 0 && dot + 1 < digits.size() &&
                                 is_digit(digits[dot - 1]) && is_digit(digits[dot + 1]);
  if (error != std::errc{} || stopped != end || !digits_around_dot)
    return wrong("a real number looks like 1.5, 1.0E3 or 2.5E-3");
  Literal literal;
  literal.kind = Literal::Kind::real;
  literal.real = negative ? -value : value;
  return literal;
}

/// 5, -5, 16#FF, 1.5
Parsed parse_number(std::string_view text) {
  const bool negative = take_sign(text);
  const std::size_t hash = text.find('#');
  if (hash == std::string_view::npos) {
    const auto digits = without_underscores(text);
    if (!digits) return wrong(digits.error());
    if (digits->find('.') != std::string::npos) return parse_real(*digits, negative);
    return parse_digits(*digits, 10, negative);
  }
  const std::string_view base = text.substr(0, hash);
  if (base != "2" && base != "8" && base != "16") return wrong("the base of a number is 2, 8 or 16: 16#FF");
  const auto digits = without_underscores(text.substr(hash + 1));
  if (!digits) return wrong(digits.error());
  return parse_digits(*digits, base == "2" ? 2 : base == "8" ? 8 : 16, negative);
}

struct DurationUnit {
  std::string_view name;
  std::int64_t length_ns;
  /// How many of it make one of the next greater unit.
  std::int64_t per_greater;
};
constexpr std::array<DurationUnit, 5> duration_units{{{"D", 86'400'000'000'000, 0},
                                                      {"H", 3'600'000'000'000, 24},
                                                      {"M", 60'000'000'000, 60},
                                                      {"S", 1'000'000'000, 60},
                                                      {"MS", 1'000'000, 1000}}};

/// Reads the parts of a duration, greatest first.
class DurationParser {
 public:
  explicit DurationParser(std::string_view text) noexcept : text_{text} {}

  Parsed run() {
    const bool negative = take_sign(text_);
    do {
      if (auto trouble = take_part()) return wrong(std::move(*trouble));
    } while (!text_.empty());
    Literal literal;
    literal.kind = Literal::Kind::duration;
    literal.type = ElementaryType::time;
    literal.duration_ns = negative ? -sum_ns_ : sum_ns_;
    return literal;
  }

 private:
  std::string_view take_digits() noexcept {
    std::size_t length = 0;
    while (length < text_.size() && is_digit(text_[length])) ++length;
    const std::string_view digits = text_.substr(0, length);
    text_.remove_prefix(length);
    return digits;
  }

  [[nodiscard]] std::optional<std::string> take_part() {
    const std::string_view whole = take_digits();
    std::string_view fraction;
    const bool has_fraction = text_.starts_with('.');
    if (has_fraction) {
      text_.remove_prefix(1);
      fraction = take_digits();
    }
    std::size_t length = 0;
    while (length < text_.size() && text_[length] >= 'A' && text_[length] <= 'Z') ++length;
    const std::string_view name = text_.substr(0, length);
    text_.remove_prefix(length);
    const bool separated = text_.size() > 1 && text_.starts_with('_');
    if (separated) text_.remove_prefix(1);

    if (whole.empty() || (has_fraction && fraction.empty()))
      return "a duration looks like T#1h2m3s4ms or T#1.5s";
    while (next_unit_ < duration_units.size() && duration_units[next_unit_].name != name) ++next_unit_;
    if (next_unit_ == duration_units.size())
      return "the parts of a duration are d, h, m, s, ms, in this order and each at most once";
    if (has_fraction && !text_.empty()) return "only the last part of a duration may have a fraction";
    return add(duration_units[next_unit_++], whole, fraction);
  }

  [[nodiscard]] std::optional<std::string> add(const DurationUnit& unit, std::string_view whole,
                                               std::string_view fraction) {
    const std::string too_long = "the duration is longer than TIME can be (292 years)";
    const auto count = parse_digits(whole, 10, false);
    std::int64_t part_ns = 0;
    if (!count || __builtin_mul_overflow(count->magnitude, unit.length_ns, &part_ns)) return too_long;
    if (!first_ && count->magnitude >= static_cast<std::uint64_t>(unit.per_greater))
      return "only the first part of a duration may exceed its unit: " + std::string{whole} +
             " carries into the next greater one";
    first_ = false;
    std::int64_t scale_ns = unit.length_ns;
    std::int64_t fraction_ns = 0;
    for (const char c : fraction) fraction_ns += (scale_ns /= 10) * (c - '0');
    if (__builtin_add_overflow(part_ns, fraction_ns, &part_ns) ||
        __builtin_add_overflow(sum_ns_, part_ns, &sum_ns_))
      return too_long;
    return std::nullopt;
  }

  std::string_view text_;
  std::size_t next_unit_ = 0;
  bool first_ = true;
  std::int64_t sum_ns_ = 0;
};

Parsed parse_typed(ElementaryType type, std::string_view rest) {
  if (type == ElementaryType::boolean && (rest == "TRUE" || rest == "FALSE"))
    rest = rest == "TRUE" ? "1" : "0";
  auto literal = parse_number(rest);
  if (!literal) return literal;
  if (is_real(type) && literal->kind == Literal::Kind::integer) {
    const auto value = static_cast<double>(literal->magnitude);
    literal->real = literal->negative ? -value : value;
    literal->kind = Literal::Kind::real;
  }
  literal->type = type;
  if (const auto value = value_as(*literal, type); !value) return wrong(value.error());
  return literal;
}

tl::expected<std::uint64_t, std::string> integer_as(const Literal& literal, ElementaryType type) {
  const auto too_big = [type] { return wrong("the number does not fit " + std::string{name_of(type)}); };
  if (is_real(type))
    return wrong("an integer is no " + std::string{name_of(type)} + ": write 5.0 instead of 5");
  if (type == ElementaryType::time) return wrong("a number is no TIME: write T#5s");
  const std::uint64_t bits = literal.negative ? 0 - literal.magnitude : literal.magnitude;
  if (is_signed_integer(type)) {
    const std::uint64_t limit = std::uint64_t{1} << (8 * size_bytes(type) - 1);
    if (literal.magnitude > limit || (literal.magnitude == limit && !literal.negative)) return too_big();
    return bits;
  }
  if (literal.negative && literal.magnitude != 0) return too_big();
  if (wrapped(type, bits) != bits) return too_big();
  return bits;
}

}  // namespace

tl::expected<Literal, std::string> parse_literal(std::string_view text) {
  const std::string capitals = upper(text);
  const std::string_view all{capitals};
  if (all == "TRUE" || all == "FALSE") return parse_typed(ElementaryType::boolean, all);
  const std::size_t hash = all.find('#');
  if (hash == std::string_view::npos || is_digit(all.front()) || all.front() == '-' || all.front() == '+')
    return parse_number(all);
  const std::string_view prefix = all.substr(0, hash);
  const std::string_view rest = all.substr(hash + 1);
  if (prefix == "T" || prefix == "TIME") return DurationParser{rest}.run();
  if (const auto type = elementary_type(prefix)) return parse_typed(*type, rest);
  return wrong(std::string{text.substr(0, hash)} + "# is no type of this PLC");
}

tl::expected<std::uint64_t, std::string> value_as(const Literal& literal, ElementaryType type) {
  if (literal.type && *literal.type != type)
    return wrong("the literal is a " + std::string{name_of(*literal.type)} + ", " +
                 std::string{name_of(type)} + " is needed: there is no implicit conversion");
  switch (literal.kind) {
    case Literal::Kind::integer:
      return integer_as(literal, type);
    case Literal::Kind::real: {
      if (type == ElementaryType::lreal) return bits_of(literal.real);
      if (type != ElementaryType::real)
        return wrong("a number with a point is no " + std::string{name_of(type)} + ": it is a REAL or LREAL");
      if (std::abs(literal.real) > double{std::numeric_limits<float>::max()})
        return wrong("the number does not fit REAL");
      return bits_of(static_cast<float>(literal.real));
    }
    case Literal::Kind::duration:
      if (type != ElementaryType::time)
        return wrong("a duration is no " + std::string{name_of(type)} + ": it is a TIME");
      return static_cast<std::uint64_t>(literal.duration_ns);
  }
  return wrong("no such literal");
}

}  // namespace emulator_models::soft_plc
