#include "fuzz/fx_frame_mutator.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "fuzz/fx_reference_frame.hpp"
#include "sim_clock/explore/random_generator.hpp"

namespace fuzz {
namespace {

constexpr char stx = 0x02;
constexpr char etx = 0x03;
constexpr char enq = 0x05;

class Mutation {
 public:
  Mutation(unsigned seed, ltsim::PlainMutator plain) : chance_{seed}, plain_{plain} {}

  std::size_t below(std::size_t bound) { return chance_.below(static_cast<std::uint32_t>(bound)); }
  bool one_in(std::size_t n) { return below(n) == 0; }
  template <class Values>
  auto one_of(const Values& values) {
    return values[below(std::size(values))];
  }

  /// The engine's own way.
  std::string changed_plainly(const std::string& text) {
    std::array<std::byte, 1200> bytes;
    const std::size_t size = std::min(text.size(), bytes.size() / 2);
    std::transform(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(size), bytes.begin(),
                   [](char c) { return static_cast<std::byte>(c); });
    const std::size_t changed = plain_(bytes, size);
    return {reinterpret_cast<const char*>(bytes.data()), changed};
  }

  std::string any_payload();
  std::string changed_payload(std::string payload);
  std::string closed(const std::string& payload);

  std::string any_frame() { return closed(any_payload()); }
  std::string changed_frame(const std::string& frame) {
    const bool is_framed = frame.size() >= 4 && frame.front() == stx && frame[frame.size() - 3] == etx;
    if (!is_framed || one_in(16)) return changed_plainly(frame);
    return closed(changed_payload(frame.substr(1, frame.size() - 4)));
  }

 private:
  unsigned any_address(bool is_force);
  unsigned any_count();
  std::string address_text(bool is_force);
  std::string any_data(std::size_t bytes);

  ltsim::RandomGenerator chance_;
  ltsim::PlainMutator plain_;
};

// Where areas begin, and the bytes behind their last ones, in one space or another.
constexpr unsigned edges[] = {0x0000, 0x0010, 0x007D, 0x0080, 0x0082, 0x0090, 0x0097, 0x00A0, 0x00A2, 0x00B0,
                              0x00B7, 0x00C0, 0x00C8, 0x00E0, 0x0100, 0x0140, 0x0180, 0x01C0, 0x01C4, 0x01DD,
                              0x01E0, 0x0200, 0x0240, 0x0260, 0x0800, 0x0880, 0x0A00, 0x0A40, 0x0B90, 0x0C00,
                              0x0C8C, 0x0CE0, 0x0E00, 0x0ECA, 0x1000, 0x1200, 0x1400, 0x4000, 0x4E80, 0x7E80,
                              0x8000, 0x8400, 0x8800, 0x8BC0, 0x8BE0, 0x8C00, 0x8C40, 0x8CA0, 0x8CC0, 0x8CE0,
                              0x8EE0, 0x9340, 0x9360, 0x93A0, 0xFFFF};
constexpr unsigned counts[] = {0, 1, 2, 3, 4, 8, 0x3E, 0x3F, 0x40, 0x41, 0x7F, 0x80, 0xFD, 0xFE, 0xFF};
constexpr std::string_view commands[] = {"0", "1", "7", "8", "E00", "E10", "E7", "E8"};

bool is_force(std::string_view letters) { return letters.ends_with('7') || letters.ends_with('8'); }
bool is_write(std::string_view letters) { return letters == "1" || letters == "E10"; }

unsigned Mutation::any_address(bool is_bit) {
  if (one_in(4)) return chance_.below(0x10000);
  const unsigned byte = one_of(edges) + static_cast<unsigned>(below(5)) - 2;
  return is_bit ? 8 * byte + static_cast<unsigned>(below(8)) : byte;
}

/// Small more often than not: what a run costs goes with the bytes.
unsigned Mutation::any_count() {
  if (one_in(2)) return static_cast<unsigned>(below(8)) + 1;
  return one_in(4) ? static_cast<unsigned>(below(0x100)) : one_of(counts);
}

std::string Mutation::address_text(bool is_bit) {
  const unsigned address = any_address(is_bit);
  if (!is_bit) return hexadecimal(address, 4);
  return hexadecimal(address, 2) + hexadecimal(address / 256, 2);
}

std::string Mutation::any_data(std::size_t bytes) {
  std::string digits;
  if (one_in(16)) bytes += below(3) + 1;
  if (one_in(16) && bytes > 0) --bytes;
  const bool is_even = one_in(2);
  const auto first = static_cast<unsigned>(below(0x100));
  for (std::size_t i = 0; i < bytes; ++i)
    digits += hexadecimal(is_even ? first : static_cast<unsigned>(below(0x100)), 2);
  return digits;
}

std::string Mutation::any_payload() {
  if (one_in(16)) return any_data(any_count());  // a reply
  const std::string letters{one_of(commands)};
  std::string payload = letters + address_text(is_force(letters));
  if (is_force(letters)) return payload;
  const unsigned count = any_count();
  payload += hexadecimal(count, 2);
  return is_write(letters) ? payload + any_data(count) : payload;
}

/// The letters with which a payload begins, as the tables have them; empty: none of them.
std::string letters_of(std::string_view payload) {
  for (const std::string_view letters : commands)
    if (payload.starts_with(letters)) return std::string{letters};
  return {};
}

std::string Mutation::changed_payload(std::string payload) {
  const std::string letters = letters_of(payload);
  const std::size_t fixed_digits = letters.size() + (is_force(letters) ? 4 : 6);
  if (letters.empty() || payload.size() < fixed_digits || one_in(4)) return changed_plainly(payload);
  switch (below(4)) {
    case 0:
      return payload.replace(letters.size(), 4, address_text(is_force(letters)));
    case 1: {
      if (is_force(letters)) return any_payload();
      const unsigned count = any_count();
      payload.replace(letters.size() + 4, 2, hexadecimal(count, 2));
      return is_write(letters) ? payload.substr(0, fixed_digits) + any_data(count) : payload;
    }
    case 2:
      return payload.replace(0, letters.size(), one_of(commands));
    default:
      return any_payload();
  }
}

std::string Mutation::closed(const std::string& payload) {
  std::string frame = framed(payload);
  if (one_in(24)) frame[frame.size() - 1 - below(2)] = "0123456789ABCDEFabc"[below(19)];
  return frame;
}

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// @return the new size
std::size_t put(std::string_view text, std::span<std::byte> data) {
  const std::size_t size = std::min(text.size(), data.size());
  std::transform(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(size), data.begin(),
                 [](char c) { return static_cast<std::byte>(c); });
  return size;
}

std::string joined(std::span<const std::string> records) {
  std::string text;
  for (const std::string& record : records) text += record;
  return text;
}

/// Puts a record in, takes one out, moves or doubles one.
void reorder(std::vector<std::string>& records, const std::string& fresh, Mutation& mutation) {
  const auto place = [&](std::size_t index) { return records.begin() + static_cast<std::ptrdiff_t>(index); };
  if (records.empty() || mutation.one_in(2)) {
    records.insert(place(mutation.below(records.size() + 1)), fresh);
    return;
  }
  const std::size_t index = mutation.below(records.size());
  const std::string record = records[index];
  if (!mutation.one_in(3)) records.erase(place(index));
  if (mutation.one_in(2)) records.insert(place(mutation.below(records.size() + 1)), record);
}

}  // namespace

std::size_t mutate_frame(std::span<std::byte> data, std::size_t size, unsigned seed,
                         ltsim::PlainMutator plain) {
  Mutation mutation{seed, plain};
  if (mutation.one_in(8)) return plain(data, size);
  if (mutation.one_in(4)) return put(mutation.any_frame(), data);
  return put(mutation.changed_frame(text_of(data.first(size))), data);
}

std::size_t mutate_stream(std::span<std::byte> data, std::size_t size, unsigned seed,
                          ltsim::PlainMutator plain) {
  Mutation mutation{seed, plain};
  if (mutation.one_in(4)) return plain(data, size);
  const std::string input = text_of(data.first(size));
  std::vector<std::string> records;
  for (const std::string_view record : frames_as_records(input)) records.emplace_back(record);
  if (records.empty() || mutation.one_in(2)) {
    constexpr std::string_view others[] = {"\x05", "\x06", "\x15", "\x02", "\xFF", "0", "\x03"};
    reorder(records, mutation.one_in(3) ? std::string{mutation.one_of(others)} : mutation.any_frame(),
            mutation);
  } else {
    std::string& record = records[mutation.below(records.size())];
    record = mutation.changed_frame(record);
  }
  return put(joined(records), data);
}

std::size_t mutate_lines(std::span<std::byte> data, std::size_t size, unsigned seed,
                         ltsim::PlainMutator plain, std::span<const std::string_view> events) {
  Mutation mutation{seed, plain};
  if (mutation.one_in(16)) return plain(data, size);
  const std::string input = text_of(data.first(size));
  std::vector<std::string> lines;
  for (const std::string_view line : ltsim::lines_as_records(input)) lines.emplace_back(line);
  if (lines.empty() || mutation.one_in(2)) {
    reorder(lines, (mutation.one_in(2) ? std::string{mutation.one_of(events)} : mutation.any_frame()) + '\n',
            mutation);
  } else {
    std::string& line = lines[mutation.below(lines.size())];
    if (line.ends_with('\n')) line.pop_back();
    line = mutation.changed_frame(line) + '\n';
  }
  return put(joined(lines), data);
}

std::vector<std::string_view> frames_as_records(std::string_view input) {
  std::vector<std::string_view> records;
  while (!input.empty()) {
    std::size_t end = 1;
    while (end < input.size() && input[end] != stx && input[end] != enq &&
           static_cast<unsigned char>(input[end]) < 0x80)
      ++end;
    records.push_back(input.substr(0, end));
    input.remove_prefix(end);
  }
  return records;
}

}  // namespace fuzz
