// SPDX-License-Identifier: Apache-2.0
#include "tests/golden/chain/whole_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hemi::golden::testing {

using namespace config;
using Word = WholeNumbers::Word;

namespace {

Word wrap(Word value, int width) {
  const int unused = 64 - width;
  return static_cast<Word>(static_cast<std::uint64_t>(value) << unused) >> unused;
}
Word wrap(Word value, const Format& format) {
  return wrap(value, format.width);
}
Word round(Word value, int drop) {
  return drop <= 0 ? value : (value + (Word{1} << (drop - 1))) >> drop;
}

}  // namespace

WholeNumbers::WholeNumbers(const InstrumentParameters& instrument, const RegisterValues& values)
    : instrument_(instrument), cic_bits_(product_bits + growth_bits(instrument.decimation, cic_order)) {
  for (std::size_t i = 0; i < r_.size(); ++i) {
    r_[i] = std::llround(std::ldexp(values[i], registers[i].format.fraction));
  }
  for (int i = 0; i <= 512; ++i)
    base_.push_back(std::llround(table_scale * std::sin(std::numbers::pi / 1024.0 * i)));
  for (int i = 0; i < 24; ++i) {
    arctangent_.push_back(
        std::llround(std::ldexp(std::atan(std::ldexp(1.0, -i)) / (2.0 * std::numbers::pi), 32)));
  }
  increment_ = pending_ = integral_ = r_[reg_nco_start];
  loops_ = {{{reg_amplitude_proportional, reg_amplitude_integral, reg_drive_limit, r_[reg_drive_start],
              status_drive_saturated, "amplitude"},
             {reg_quadrature_proportional, reg_quadrature_integral, reg_quadrature_limit,
              r_[reg_quadrature_start], status_quadrature_saturated, "quadrature"},
             {reg_rebalance_proportional, reg_rebalance_integral, reg_rebalance_limit, 0,
              status_rebalance_saturated, "rebalance"}}};
}

Word WholeNumbers::saturate(Word value, const Format& format, StatusBit bit) {
  const Word limit = Word{1} << (format.width - 1);
  raise(bit, value < -limit || value >= limit);
  return std::clamp(value, -limit, limit - 1);
}

Word WholeNumbers::sine(Word angle) const {
  const Word quadrant = (angle >> 22) & 3;
  const Word low = angle & 0x3fffff;
  const Word u = quadrant % 2 == 0 ? low : 0x3fffff - low;
  const auto i = static_cast<std::size_t>(u >> 13);
  const Word fine = u & 0x1fff;
  const Word q = (base_[i] * 16384 + (base_[i + 1] - base_[i]) * (2 * fine + 1) + 16384) >> 15;
  return quadrant < 2 ? q : -q;
}

std::array<Word, 3> WholeNumbers::sample(Word x, Word y, bool gap) {
  const Word s = nco_sine(phase_);
  const Word c = nco_sine(phase_ + (Word{1} << 46));
  const int drop = instrument_.adc_bits - 1 + 19 - 23;
  const std::array<Word, 4> products = {round(x * c, drop), -round(x * s, drop), round(y * c, drop),
                                        -round(y * s, drop)};
  taps.insert(taps.end(), {phase_, c, s});
  taps.insert(taps.end(), products.begin(), products.end());
  const Word carrier = nco_sine(wrap(phase_ + offset_now_ * 65536, phase));
  const Word drive_word = dac_word(round(-(drive_now_ * carrier), 19), drive_error_);
  const Word rebalance_word = dac_word(round(-(rebalance_now_ * carrier), 19), rebalance_error_);
  const std::array<Word, 3> words = {drive_word, rebalance_word, quadrature_now_};
  taps.insert(taps.end(), {carrier, drive_word, rebalance_word});
  for (std::size_t channel = 0; channel < 4; ++channel) {
    Word carry = products[channel];
    for (Word& integrator : combs_[channel].s) carry = integrator = wrap(integrator + carry, cic_bits_);
  }
  const Word rail = Word{1} << (instrument_.adc_bits - 1);
  raise(status_adc_overload, x == -rail || x == rail - 1 || y == -rail || y == rail - 1);
  raise(status_sample_gap, gap);
  phase_ = wrap(phase_ + increment_, phase);
  if (++samples_ < instrument_.decimation) return words;
  samples_ = 0;
  tick();
  if (++ticks_ < ticks_per_output) return words;
  ticks_ = 0;
  output();
  return words;
}

std::array<Word, 2> WholeNumbers::detect(Word i, Word q) {
  Word x = i * 32;
  Word y = q * 32;
  Word z = 0;
  if (x < 0) {
    x = -x;
    y = -y;
    z = -(Word{1} << 31);
  }
  for (int k = 0; k < 24; ++k) {
    const Word dx = y >> k;
    const Word dy = x >> k;
    const Word a = arctangent_[static_cast<std::size_t>(k)];
    if (y < 0) {
      x -= dx;
      y += dy;
      z = wrap(z - a, angle);
    } else {
      x += dx;
      y -= dy;
      z = wrap(z + a, angle);
    }
  }
  return {x, z};
}

void WholeNumbers::loop(Word amplitude, Word phase_error) {
  const bool low = amplitude < r_[reg_amplitude_threshold];
  const Word d = wrap(phase_error - last_error_, angle);
  last_error_ = phase_error;
  const auto add = [this](Word sum, Word error, RegisterIndex gain) {
    const int drop = 32 + registers[gain].format.fraction - increment.fraction;
    return saturate(sum + round(error * r_[gain], drop), increment, status_loop_saturated);
  };
  if (!low) {
    const Word far = Word{1} << steering_window_log2;
    if (!locked_ && (d < -far || d >= far)) integral_ = add(integral_, d, reg_loop_frequency);
    integral_ = add(integral_, phase_error, reg_loop_integral);
    pending_ = add(integral_, phase_error, reg_loop_proportional);
    const Word window = Word{1} << lock_window_log2;
    counter_ = -window <= phase_error && phase_error < window ? std::min(counter_ + 1, r_[reg_lock_count])
                                                              : std::max<Word>(counter_ - 4, 0);
  } else {
    pending_ = integral_;
  }
  if (counter_ >= r_[reg_lock_count]) locked_ = true;
  if (counter_ == 0) locked_ = false;
  raise(status_unlocked, !locked_);
  raise(status_holdover, locked_ && low);
}

Word WholeNumbers::track(Word phase_error) {
  const Word half = wrap(phase_ - last_p_, phase) >> 1;
  std::copy_backward(c_.begin(), c_.end() - 1, c_.end());
  c_[0] = wrap(wrap(phase_ - half, phase) >> 16, tick_phase);
  last_p_ = phase_;
  const Word p = wrap(c_[4] + phase_error, tick_phase);
  total_ = wrap(total_ + wrap(p - last_tick_phase_, tick_phase), total_phase);
  last_tick_phase_ = p;
  sum_ = wrap(sum_ + total_, total_phase);
  return p;
}

void WholeNumbers::tick() {
  increment_ = pending_;
  drive_now_ = drive_;
  rebalance_now_ = loops_[2].command;
  offset_now_ = offset_;
  quadrature_now_ = dac_quadrature_;
  std::array<Word, 4> cic{};
  std::array<Word, 4> baseband_words{};
  for (std::size_t channel = 0; channel < 4; ++channel) {
    Comb& comb = combs_[channel];
    Word v = comb.s[4];
    for (Word& d : comb.d) {
      const Word t = wrap(v - d, cic_bits_);
      d = v;
      v = t;
    }
    cic[channel] = round(v, cic_bits_ - 28);
    std::copy_backward(comb.u.begin(), comb.u.end() - 1, comb.u.end());
    comb.u[0] = cic[channel];
    Word sum = 0;
    for (std::size_t i = 0; i < 5; ++i) sum += image_taps[i] * comb.u[i];
    baseband_words[channel] = round(sum, image_shift);
  }
  const auto [amplitude, phase_error] = detect(baseband_words[0], baseband_words[1]);
  const Word c = r_[reg_demodulation_cos];
  const Word s = r_[reg_demodulation_sin];
  const auto secondary = [&](Word v) { return saturate(round(v, 22), baseband, status_secondary_saturated); };
  const Word in_phase = secondary(baseband_words[2] * c + baseband_words[3] * s);
  const Word quadrature = secondary(baseband_words[3] * c - baseband_words[2] * s);
  start_up(amplitude);
  loop(amplitude, phase_error);
  actuate(amplitude, in_phase, quadrature);
  modulate();
  const Word p = track(phase_error);
  const bool closed_loop = (r_[reg_control] & 1) != 0;
  const Word source = closed_loop ? loops_[2].command : in_phase;
  const Word rate_word =
      saturate(round(source * r_[reg_rate_gain], closed_loop ? 17 : 14), rate_tick, status_rate_saturated);
  r1_ = wrap(r1_ + rate_word, rate_accumulator);
  r2_ = wrap(r2_ + r1_, rate_accumulator);
  taps.insert(taps.end(), cic.begin(), cic.end());
  taps.insert(taps.end(), baseband_words.begin(), baseband_words.end());
  taps.insert(taps.end(), {amplitude, phase_error, in_phase, quadrature, state_, integral_, pending_,
                           counter_, loops_[0].sum, drive_, loops_[1].sum, loops_[1].command, loops_[2].sum,
                           loops_[2].command, offset_, dac_quadrature_, p, rate_word});
}

void WholeNumbers::output() {
  const Word frequency_word = wrap(sum_ - last_sum_, frequency);
  last_sum_ = sum_;
  sum_ = 0;
  const Word t = wrap(r2_ - e1_, rate_accumulator);
  e1_ = r2_;
  const Word v = wrap(t - e2_, rate_accumulator);
  e2_ = t;
  const bool valid = outputs_++ >= 2;
  raise(status_frequency_invalid, !valid);
  finish(frequency_word, saturate(round(v, 10), rate, status_rate_saturated), valid && locked_);
}

void WholeNumbers::telemetry(Word frequency_word, Word rate_word, bool valid) {
  raise(status_frequency_invalid, !valid);
  finish(frequency_word, rate_word, valid);
}

void WholeNumbers::finish(Word frequency_word, Word rate_word, bool good) {
  const Word difference = frequency_word - r_[reg_frequency_reference];
  const Word o = saturate(round(difference, 12), offset, status_frequency_out_of_range);
  Word t = r_[reg_thermometer_5];
  for (int i = 4; i >= 0; --i) {
    t = saturate(round(t * o, 23) + r_[static_cast<std::size_t>(reg_thermometer_0 + i)], temperature,
                 status_thermometer_saturated);
  }
  raise(status_out_of_calibrated_range, o < r_[reg_calibrated_low] || o > r_[reg_calibrated_high]);
  if (!good) {
    block_sum_ = count_ = fill_ = derivative_ = 0;
  } else {
    block_sum_ = wrap(block_sum_ + saturate(round(difference, 4), fine_offset, status_derivative_saturated),
                      block_sum);
    if (++count_ == Word{1} << r_[reg_log2_block]) {
      std::copy(b_.begin() + 1, b_.end(), b_.begin());
      b_[15] = block_sum_;
      block_sum_ = count_ = 0;
      fill_ = std::min<Word>(fill_ + 1, 16);
      if (fill_ == 16) {
        slope_sum_ = 0;
        for (std::size_t j = 0; j < 8; ++j)
          slope_sum_ += (15 - 2 * static_cast<Word>(j)) * (b_[15 - j] - b_[j]);
        const Word v = saturate(round(slope_sum_, static_cast<int>(r_[reg_slope_shift])), slope_word,
                                status_derivative_saturated);
        derivative_ = saturate(round(v * r_[reg_slope_gain], 29), derivative, status_derivative_saturated);
      }
    }
  }
  raise(status_derivative_invalid, fill_ < 16);
  const Word g = derivative_;
  const auto step = [this](Word factor, Word variable, Word addend) {
    return saturate(round(factor * variable, 23) + addend, bias, status_bias_saturated);
  };
  Word p = step(r_[reg_bias_f3], o, r_[reg_bias_f2]);
  p = step(p, o, r_[reg_bias_f]);
  Word a = step(r_[reg_bias_df3], g, r_[reg_bias_df2]);
  a = step(r_[reg_bias_f_df2], o, a);
  Word b = step(r_[reg_bias_f2_df], o, r_[reg_bias_f_df]);
  b = step(b, o, r_[reg_bias_df]);
  const Word c = step(a, g, b);
  Word bias_word = step(c, g, r_[reg_bias_0]);
  bias_word = step(p, o, bias_word);
  const Word e = rate_word - bias_word * 8;
  const Word h = e >> 5;
  const Word compensated =
      saturate(e + round(h * r_[reg_scale_correction], 18), rate, status_compensation_saturated);
  std::uint64_t parity = 0;
  for (const Word word : r_) parity ^= static_cast<std::uint64_t>(word);
  raise(status_parity_error, (parity << 10) != 0);
  if (((live_ >> status_unlocked | live_ >> status_starting | live_ >> status_frequency_invalid) & 1) == 0)
    armed_ = true;
  if (armed_) sticky_ |= live_;
  taps.insert(taps.end(), {frequency_word, rate_word, o, t, slope_sum_, derivative_, bias_word, compensated,
                           (sticky_ << 24) + live_});
  live_ = 0;
}

}  // namespace hemi::golden::testing
