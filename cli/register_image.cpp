// SPDX-License-Identifier: Apache-2.0
#include "cli/register_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>

#include "cli/recording/json.hpp"
#include "tb/registers.hpp"

namespace hemi::cli {
namespace {

constexpr int image_bits = 54;  ///< the widest register: all words of a memory file have that width

std::string hex_of(std::int64_t raw, int bits) {
  return fmt::format("{:0{}x}", static_cast<std::uint64_t>(raw) & ((std::uint64_t{1} << bits) - 1),
                     (bits + 3) / 4);
}

/// A name from a file, fit for a comment of either language: it ends neither the comment nor the line.
std::string comment_of(const std::string& device) {
  if (device.empty()) return "one instrument";
  std::string text = device;
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) || c == '/' || c == '\\'; },
      ' ');
  return text;
}

std::string note_on(int i, const tb::RegisterImage& image) {
  const auto& r = config::registers[i];
  return fmt::format("{}: {:.9g} {}, {} bits, fraction {}", r.name, tb::to_value(image[i], r.format), r.unit,
                     r.format.width, r.format.fraction);
}

}  // namespace

std::string image_as_json(const tb::RegisterImage& image, const tb::RegisterValues& values,
                          const std::string& device) {
  recording::Json json = {{"format", "hemi-registers/1"}, {"device", device}};
  for (int i = 0; i < config::register_count; ++i) {
    const auto& r = config::registers[i];
    const double stored = tb::to_value(image[i], r.format);
    recording::Json entry = {{"index", i},
                             {"name", r.name},
                             {"value", stored},
                             {"unit", r.unit},
                             {"raw", image[i]},
                             {"hex", hex_of(image[i], r.format.width)},
                             {"width", r.format.width},
                             {"fraction", r.format.fraction},
                             {"meaning", r.meaning}};
    if (i != config::reg_parity) entry["rounding_error"] = stored - values[i];
    json["registers"].push_back(entry);
  }
  return recording::json_text(json, 2) + "\n";
}

std::string image_as_c(const tb::RegisterImage& image, const std::string& device) {
  std::string text = fmt::format(
      "/* Register image of {}: raw words, value = raw * 2^-fraction. Made by hemi. */\n"
      "#ifndef HEMI_REGISTER_IMAGE_H\n#define HEMI_REGISTER_IMAGE_H\n\n#include <stdint.h>\n\n",
      comment_of(device));
  text += fmt::format("#define HEMI_REGISTER_COUNT {}\n\n", int{config::register_count});
  text += "static const int64_t hemi_register_image[HEMI_REGISTER_COUNT] = {\n";
  for (int i = 0; i < config::register_count; ++i)
    text += fmt::format("    INT64_C({}), /* {} */\n", image[i], note_on(i, image));
  return text + "};\n\n#endif\n";
}

std::string image_as_systemverilog(const tb::RegisterImage& image, const std::string& device) {
  std::string text = fmt::format(
      "// Register image of {}. Made by hemi.\n\n"
      "/// Raw words, value = raw * 2^-fraction; word i is Image[WordBits * i +: WordBits].\n"
      "package hemi_register_image_pkg;\n"
      "  localparam int Registers = {};\n  localparam int WordBits = {};\n"
      "  localparam logic [Registers*WordBits-1:0] Image = {{\n",
      comment_of(device), int{config::register_count}, image_bits);
  // The first name of a concatenation is the highest.
  for (int i = config::register_count - 1; i >= 0; --i)
    text += fmt::format("    {}'h{}{}  // {}\n", image_bits, hex_of(image[i], image_bits), i > 0 ? "," : "",
                        note_on(i, image));
  return text + "  };\nendpackage\n";
}

std::string image_as_memory(const tb::RegisterImage& image) {
  std::string text = fmt::format("// {} words of {} bits, two's complement, in the order of the registers\n",
                                 int{config::register_count}, image_bits);
  for (int i = 0; i < config::register_count; ++i)
    text += fmt::format("{} // {}\n", hex_of(image[i], image_bits), config::registers[i].name);
  return text;
}

}  // namespace hemi::cli
