// argc and argv of a main(), which may change the strings and the array: each call of it begins with others.
#pragma once

#include <string>
#include <vector>

namespace ltsim {

class MainArguments {
 public:
  /// As they are at the begin of main().
  /// @param words  the program's path first
  void begin(const std::vector<std::string>& words) {
    words_ = words;
    pointers_.clear();
    for (std::string& word : words_) pointers_.push_back(word.data());
    pointers_.push_back(nullptr);
  }

  [[nodiscard]] int count() const noexcept { return static_cast<int>(words_.size()); }
  [[nodiscard]] char** pointers() noexcept { return pointers_.data(); }

 private:
  std::vector<std::string> words_;
  std::vector<char*> pointers_;
};

}  // namespace ltsim
