#include "emulator_models/soft_plc/il_operations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace emulator_models::soft_plc {
namespace {

constexpr std::int64_t ns_per_ms = 1'000'000;

template <typename T>
std::uint64_t compare(Operation operation, T left, T right) noexcept {
  switch (operation) {
    case Operation::greater:
      return left > right;
    case Operation::greater_equal:
      return left >= right;
    case Operation::equal:
      return left == right;
    case Operation::not_equal:
      return left != right;
    case Operation::less_equal:
      return left <= right;
    default:
      return left < right;
  }
}

template <typename Real>
OperationResult operate_reals(Operation operation, Real left, Real right) noexcept {
  if (is_comparison(operation)) return compare(operation, left, right);
  switch (operation) {
    case Operation::add:
      return bits_of(left + right);
    case Operation::sub:
      return bits_of(left - right);
    case Operation::mul:
      return bits_of(left * right);
    case Operation::div:
      if (right == Real{0}) return tl::unexpected(FaultKind::division_by_zero);
      return bits_of(left / right);
    case Operation::minimum:
      return bits_of(std::min(left, right));
    default:
      return bits_of(std::max(left, right));
  }
}

/// Division cannot be left to wrap: the least integer by -1 traps on the host.
OperationResult divide_signed(Operation operation, std::int64_t left, std::int64_t right) noexcept {
  if (right == 0) return tl::unexpected(FaultKind::division_by_zero);
  if (right == -1) return operation == Operation::div ? 0 - static_cast<std::uint64_t>(left) : 0;
  return static_cast<std::uint64_t>(operation == Operation::div ? left / right : left % right);
}

OperationResult divide_unsigned(Operation operation, std::uint64_t left, std::uint64_t right) noexcept {
  if (right == 0) return tl::unexpected(FaultKind::division_by_zero);
  return operation == Operation::div ? left / right : left % right;
}

OperationResult operate_integers(Operation operation, bool is_signed, std::uint64_t left,
                                 std::uint64_t right) noexcept {
  const auto signed_left = static_cast<std::int64_t>(left);
  const auto signed_right = static_cast<std::int64_t>(right);
  if (is_comparison(operation))
    return is_signed ? compare(operation, signed_left, signed_right) : compare(operation, left, right);
  const bool left_is_less = is_signed ? signed_left < signed_right : left < right;
  switch (operation) {
    case Operation::bit_and:
      return left & right;
    case Operation::bit_or:
      return left | right;
    case Operation::bit_xor:
      return left ^ right;
    case Operation::add:
      return left + right;
    case Operation::sub:
      return left - right;
    case Operation::mul:
      return left * right;
    case Operation::minimum:
      return left_is_less ? left : right;
    case Operation::maximum:
      return left_is_less ? right : left;
    default:
      return is_signed ? divide_signed(operation, signed_left, signed_right)
                       : divide_unsigned(operation, left, right);
  }
}

double as_double(ElementaryType type, std::uint64_t value) noexcept {
  if (type == ElementaryType::real) return double{as_real(value)};
  if (type == ElementaryType::lreal) return as_lreal(value);
  if (is_signed_integer(type)) return static_cast<double>(static_cast<std::int64_t>(value));
  return static_cast<double>(value);
}

OperationResult real_to_integer(ElementaryType to, double value) noexcept {
  const bool is_signed = is_signed_integer(to) || to == ElementaryType::time;
  const auto width = static_cast<int>(8 * size_bytes(to));
  const double end = std::ldexp(1.0, is_signed ? width - 1 : width);
  const double begin = is_signed ? -end : 0.0;
  const double rounded = std::nearbyint(value);
  if (!(rounded >= begin && rounded < end)) return tl::unexpected(FaultKind::conversion_out_of_range);
  if (is_signed) return static_cast<std::uint64_t>(static_cast<std::int64_t>(rounded));
  return static_cast<std::uint64_t>(rounded);
}

constexpr std::array<NamedOperation, 17> named_operations{{{"AND", Operation::bit_and, false},
                                                           {"ANDN", Operation::bit_and, true},
                                                           {"OR", Operation::bit_or, false},
                                                           {"ORN", Operation::bit_or, true},
                                                           {"XOR", Operation::bit_xor, false},
                                                           {"XORN", Operation::bit_xor, true},
                                                           {"ADD", Operation::add, false},
                                                           {"SUB", Operation::sub, false},
                                                           {"MUL", Operation::mul, false},
                                                           {"DIV", Operation::div, false},
                                                           {"MOD", Operation::mod, false},
                                                           {"GT", Operation::greater, false},
                                                           {"GE", Operation::greater_equal, false},
                                                           {"EQ", Operation::equal, false},
                                                           {"NE", Operation::not_equal, false},
                                                           {"LE", Operation::less_equal, false},
                                                           {"LT", Operation::less, false}}};

}  // namespace

const NamedOperation* find_operation(std::string_view upper_name) noexcept {
  for (const NamedOperation& one : named_operations) {
    if (one.name == upper_name) return &one;
  }
  return nullptr;
}

std::string_view to_string(FaultKind kind) noexcept {
  switch (kind) {
    case FaultKind::division_by_zero:
      return "division by zero";
    case FaultKind::budget_spent:
      return "more instructions in one scan than allowed";
    case FaultKind::conversion_out_of_range:
      return "the number does not fit the type it is converted to";
    case FaultKind::negative_shift:
      return "shift by a negative number of bits";
    case FaultKind::image_too_small:
      return "the process image ends before an address that the program uses";
  }
  return "unknown fault";
}

OperationResult operate(Operation operation, ElementaryType type, std::uint64_t left,
                        std::uint64_t right) noexcept {
  if (type == ElementaryType::real) return operate_reals(operation, as_real(left), as_real(right));
  if (type == ElementaryType::lreal) return operate_reals(operation, as_lreal(left), as_lreal(right));
  const bool is_signed = is_signed_integer(type) || type == ElementaryType::time;
  const OperationResult result = operate_integers(operation, is_signed, left, right);
  if (!result || is_comparison(operation)) return result;
  return wrapped(type, *result);
}

std::uint64_t absolute(ElementaryType type, std::uint64_t value) noexcept {
  if (type == ElementaryType::real) return bits_of(std::abs(as_real(value)));
  if (type == ElementaryType::lreal) return bits_of(std::abs(as_lreal(value)));
  const bool negative = is_signed_integer(type) && static_cast<std::int64_t>(value) < 0;
  return wrapped(type, negative ? 0 - value : value);
}

OperationResult convert(ElementaryType from, ElementaryType to, std::uint64_t value) noexcept {
  if (from == ElementaryType::time) {
    const std::int64_t ms = static_cast<std::int64_t>(value) / ns_per_ms;
    return convert(ElementaryType::lint, to, static_cast<std::uint64_t>(ms));
  }
  if (to == ElementaryType::time) {
    const OperationResult ms = convert(from, ElementaryType::lint, value);
    if (!ms) return ms;
    std::int64_t ns = 0;
    if (__builtin_mul_overflow(static_cast<std::int64_t>(*ms), ns_per_ms, &ns))
      return tl::unexpected(FaultKind::conversion_out_of_range);
    return static_cast<std::uint64_t>(ns);
  }
  if (to == ElementaryType::boolean) return is_real(from) ? as_double(from, value) != 0.0 : value != 0;
  if (to == ElementaryType::lreal) return bits_of(as_double(from, value));
  if (to == ElementaryType::real) {
    if (from != ElementaryType::lreal) return bits_of(static_cast<float>(as_double(from, value)));
    const double wide = as_lreal(value);
    if (std::isfinite(wide) && std::abs(wide) > double{std::numeric_limits<float>::max()})
      return tl::unexpected(FaultKind::conversion_out_of_range);
    return bits_of(static_cast<float>(wide));
  }
  if (is_real(from)) return real_to_integer(to, as_double(from, value));
  return wrapped(to, value);
}

OperationResult shift(ShiftKind kind, ElementaryType type, std::uint64_t value, ElementaryType count_type,
                      std::uint64_t count) noexcept {
  if (is_signed_integer(count_type) && static_cast<std::int64_t>(count) < 0)
    return tl::unexpected(FaultKind::negative_shift);
  const std::uint64_t width = 8 * size_bytes(type);
  // The accumulator is wider than most types: bits shifted out to the left go when the result is wrapped.
  const auto shifted = [&](bool left, std::uint64_t by) {
    if (by >= 64) return std::uint64_t{0};
    return left ? value << by : value >> by;
  };
  switch (kind) {
    case ShiftKind::left:
      return wrapped(type, shifted(true, count));
    case ShiftKind::right:
      return shifted(false, count);
    case ShiftKind::rotate_left:
    case ShiftKind::rotate_right:
      break;
  }
  const std::uint64_t by = count % width;
  const bool left = kind == ShiftKind::rotate_left;
  return wrapped(type, shifted(left, by) | shifted(!left, width - by));
}

}  // namespace emulator_models::soft_plc
