// What a whole program has asked to be called when it exits: atexit(3), destructors of static objects. Each execution exits once.
#pragma once

#include <vector>

namespace ltsim {

class ExitHandlers {
 public:
  struct Handler {
    void (*function)(void*);
    void* argument;
  };

  static void add(Handler handler) { handlers_.push_back(handler); }
  /// What was added up to now was so before main(), and is there in each execution.
  static void keep_for_each_execution() { kept_ = handlers_; }
  static void restore() { handlers_ = kept_; }
  /// Calls them, the last one that was added first; what is added meanwhile, too.
  static void run();

 private:
  static inline std::vector<Handler> handlers_;
  static inline std::vector<Handler> kept_;
};

}  // namespace ltsim
