// SPDX-License-Identifier: Apache-2.0
// Tops of the whole core, both instruments.
#include "hls/core.hpp"
#include "hls/tops/ports.hpp"
#include "hls/tops/tops.hpp"

namespace {

/// The core behind its register file.
template <class Instrument>
class Port {
 public:
  void write(std::int32_t address, std::int64_t data) {
    if (address >= 0 && address < hemi::config::register_count) registers_[address] = data;
  }
  void reset() { core_.reset(registers_); }

  bool step(bool telemetry, std::int32_t x, std::int32_t y, bool gap, std::int64_t frequency,
            std::int64_t rate, std::int64_t* record) {
    hemi::hls::NoProbe probe;
    hemi::hls::Record words;
    bool complete = true;
    if (telemetry) {
      core_.telemetry(frequency, rate, !gap, words, probe);
    } else {
      complete = core_.sample(x, y, gap, words, probe);
    }
    if (complete)
      for (int i = 0; i < hemi::config::record_words; ++i) record[i] = words.word[i];
    return complete;
  }

  const hemi::hls::Core<Instrument>& core() const { return core_; }

 private:
  std::int64_t registers_[hemi::config::register_count] = {};
  hemi::hls::Core<Instrument> core_;
};

template <class Instrument>
void call(Port<Instrument>& port, bool write, std::int32_t address, std::int64_t data, bool reset,
          bool telemetry, std::int32_t x, std::int32_t y, bool gap, std::int64_t frequency, std::int64_t rate,
          bool* record_valid, std::int64_t* record, std::int32_t* dac_drive, std::int32_t* dac_rebalance,
          std::int32_t* dac_quadrature) {
  bool complete = false;
  if (write) {
    port.write(address, data);
  } else if (reset) {
    port.reset();
  } else {
    complete = port.step(telemetry, x, y, gap, frequency, rate, record);
  }
  *record_valid = complete;
  *dac_drive = port.core().dac_drive();
  *dac_rebalance = port.core().dac_rebalance();
  *dac_quadrature = port.core().dac_quadrature();
}

}  // namespace

HEMI_TOP_OUTPUT(record_valid)
HEMI_TOP_OUTPUT_ARRAY(record, 11)
HEMI_TOP_OUTPUT(dac_drive)
HEMI_TOP_OUTPUT(dac_rebalance)
HEMI_TOP_OUTPUT(dac_quadrature)
extern "C" void hemi_core_reference(std::uint8_t write, std::int32_t address, std::int64_t data,
                                    std::uint8_t reset, std::uint8_t telemetry, std::int32_t x,
                                    std::int32_t y, std::uint8_t gap, std::int64_t frequency,
                                    std::int64_t rate, bool* record_valid,
                                    std::int64_t record[hemi::config::record_words], std::int32_t* dac_drive,
                                    std::int32_t* dac_rebalance, std::int32_t* dac_quadrature) {
  static Port<hemi::config::Reference> port;
  call(port, write != 0, address, data, reset != 0, telemetry != 0, x, y, gap != 0, frequency, rate,
       record_valid, record, dac_drive, dac_rebalance, dac_quadrature);
}

HEMI_TOP_OUTPUT(record_valid)
HEMI_TOP_OUTPUT_ARRAY(record, 11)
HEMI_TOP_OUTPUT(dac_drive)
HEMI_TOP_OUTPUT(dac_rebalance)
HEMI_TOP_OUTPUT(dac_quadrature)
extern "C" void hemi_core_wide(std::uint8_t write, std::int32_t address, std::int64_t data,
                               std::uint8_t reset, std::uint8_t telemetry, std::int32_t x, std::int32_t y,
                               std::uint8_t gap, std::int64_t frequency, std::int64_t rate,
                               bool* record_valid, std::int64_t record[hemi::config::record_words],
                               std::int32_t* dac_drive, std::int32_t* dac_rebalance,
                               std::int32_t* dac_quadrature) {
  static Port<hemi::config::Wide> port;
  call(port, write != 0, address, data, reset != 0, telemetry != 0, x, y, gap != 0, frequency, rate,
       record_valid, record, dac_drive, dac_rebalance, dac_quadrature);
}
static_assert(hemi::config::record_words == 11, "the length of `record` above");
