// A producer publishes a route through an atomic pointer; a reader uses it if it is there.
// Bug: the pointer is stored before the fields are filled in: a data race, the reader may see zeroes.
// Correction: fill in, then publish.

#include <atomic>
#include <cstdio>
#include <memory>
#include <thread>

struct Route {
  int hops = 0;
  int cost = 0;
};

static std::atomic<Route*> published{nullptr};

static void produce(Route& route) {
#ifndef CORRECTED
  published.store(&route);
#endif
  route.hops = 3;
  route.cost = 30;
#ifdef CORRECTED
  published.store(&route);
#endif
}

int main() {
  const auto route = std::make_unique<Route>();
  bool wrong = false;
  std::thread reader([&wrong] {
    for (int look = 0; look < 2; ++look) {
      const Route* const seen = published.load();
      if (seen != nullptr) wrong = wrong || seen->hops != 3 || seen->cost != 30;
    }
  });
  std::thread producer([&route] { produce(*route); });
  reader.join();
  producer.join();
  if (wrong) {
    std::fprintf(stderr, "a route without hops or cost was used\n");
    return 1;
  }
  return 0;
}
