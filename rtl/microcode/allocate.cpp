// SPDX-License-Identifier: Apache-2.0
#include "rtl/microcode/allocate.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "rtl/address_map.hpp"
#include "rtl/microcode/dependence.hpp"

namespace hemi::microcode {
namespace {

struct Life {
  int word;
  bool background;
  int first;
  int last;
};

/// Region in which `word` lives alone; nullptr when it outlives one or must start from what it was.
const Region* home(const Assembler& m, Word word, Word nowhere) {
  const Region* found = nullptr;
  for (const Region& region : m.regions()) {
    for (const Instruction& i : region.lines) {
      const bool written = writes(i, nowhere) && i.dst == word;
      if (!written && !reads(i, word)) continue;
      if (found == &region) continue;
      const bool fresh = written && i.condition == Condition::always && !reads(i, word);
      if (found != nullptr || !fresh) return nullptr;
      found = &region;
    }
  }
  return found;
}

Life life(const Schedule& s, Word word, bool background, Word nowhere) {
  Life span{word.address, background, -1, -1};
  for (std::size_t address = 0; address < s.program.size(); ++address) {
    const Instruction& i = s.program[address];
    if (!(writes(i, nowhere) && i.dst == word) && !reads(i, word)) continue;
    if (span.first < 0) span.first = static_cast<int>(address);
    span.last = static_cast<int>(address);
  }
  return span;
}

}  // namespace

void allocate(const Assembler& m, Schedule& s) {
  const Word nowhere = m.words().at("nowhere");
  int next = first_state_address;
  std::vector<Life> lives;
  for (const auto& [name, word] : m.words()) {
    const Region* region = word == nowhere ? nullptr : home(m, word, nowhere);
    if (region == nullptr) {
      s.addresses[word.address] = next++;
    } else {
      lives.push_back(life(s, word, region->background, nowhere));
    }
  }
  std::sort(lives.begin(), lives.end(), [](const Life& a, const Life& b) { return a.first < b.first; });
  std::vector<Life> owners;  // the last word of each shared address
  for (const Life& l : lives) {
    const auto free = std::find_if(owners.begin(), owners.end(), [&](const Life& o) {
      return o.last < l.first && o.background == l.background;
    });
    const auto place = free == owners.end() ? owners.insert(owners.end(), l) : free;
    *place = l;
    s.addresses[l.word] = next + static_cast<int>(place - owners.begin());
  }
  s.state_end = next + static_cast<int>(owners.size());
  if (s.state_end > first_reserved) throw std::logic_error("the state memory is full");
}

}  // namespace hemi::microcode
