// SPDX-License-Identifier: Apache-2.0
// bench VECTORS RESULT: calls the top HEMI_TOP with each row of VECTORS and writes the number of calls and a
// hash over all outputs of all calls to RESULT.
//
// The same program runs twice: with the top compiled for this machine, and with the simulated Verilog behind
// the top's name. Equal hashes mean equal outputs. C++14, as HLS tools compile it with what they have.
#include <array>
#include <cstdint>
#include <cstdio>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "hls/tops/tops.hpp"

#ifndef HEMI_TOP
#error "HEMI_TOP: the name of the top"
#endif

namespace {

/// FNV-1a with 64 bits over the bytes of words, lowest first.
class Hash {
 public:
  void add(std::int64_t word) {
    for (int byte = 0; byte < 8; ++byte) {
      value_ ^= (static_cast<std::uint64_t>(word) >> (8 * byte)) & 0xff;
      value_ *= 0x100000001b3;
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325;
};

/// An input: the next word of the row.
template <class Port>
struct Slot {
  Port value{};
  void take(const std::int64_t*& row) { value = static_cast<Port>(*row++); }
  Port argument() { return value; }
  void add_to(Hash&) const {}
  static constexpr std::size_t columns = 1;
};

/// An output: room for the longest port, a record; shorter ones leave the rest zero.
template <class Word>
struct Slot<Word*> {
  Word words[hemi::config::record_words] = {};
  void take(const std::int64_t*&) {}
  Word* argument() { return words; }
  void add_to(Hash& hash) const {
    for (const Word word : words) hash.add(word);
  }
  static constexpr std::size_t columns = 0;
};

constexpr std::size_t sum() {
  return 0;
}
template <class... More>
constexpr std::size_t sum(std::size_t first, More... more) {
  return first + sum(more...);
}

template <class... Ports>
class Bench {
 public:
  static constexpr std::size_t columns = sum(Slot<Ports>::columns...);

  void call(void (*top)(Ports...), const std::int64_t* row) {
    call(top, row, std::index_sequence_for<Ports...>());
  }
  std::uint64_t hash() const { return hash_.value(); }

 private:
  template <std::size_t... I>
  void call(void (*top)(Ports...), const std::int64_t* row, std::index_sequence<I...>) {
    const std::array<int, sizeof...(I)> taken = {{(std::get<I>(slots_).take(row), 0)...}};
    top(std::get<I>(slots_).argument()...);
    const std::array<int, sizeof...(I)> hashed = {{(std::get<I>(slots_).add_to(hash_), 0)...}};
    static_cast<void>(taken);
    static_cast<void>(hashed);
  }

  std::tuple<Slot<Ports>...> slots_;
  Hash hash_;
};

template <class... Ports>
int run(void (*top)(Ports...), std::FILE* vectors, std::FILE* result) {
  Bench<Ports...> bench;
  std::vector<std::int64_t> row(Bench<Ports...>::columns);
  unsigned long calls = 0;
  while (std::fread(row.data(), sizeof row[0], row.size(), vectors) == row.size()) {
    bench.call(top, row.data());
    ++calls;
  }
  std::fprintf(result, "calls %lu\nhash %016llx\n", calls, static_cast<unsigned long long>(bench.hash()));
  return calls > 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: bench VECTORS RESULT\n");
    return 2;
  }
  std::FILE* vectors = std::fopen(argv[1], "rb");
  std::FILE* result = std::fopen(argv[2], "w");
  if (vectors == nullptr || result == nullptr) {
    std::fprintf(stderr, "bench: cannot open %s\n", vectors == nullptr ? argv[1] : argv[2]);
    return 2;
  }
  const int code = run(HEMI_TOP, vectors, result);
  std::fclose(vectors);
  return std::fclose(result) == 0 ? code : 2;
}
