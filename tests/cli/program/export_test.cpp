// SPDX-License-Identifier: Apache-2.0
// hemi export: the same words through a C compiler, a C++ compiler, $readmemh and a SystemVerilog package.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "tb/registers.hpp"
#include "tests/cli/program/program.hpp"

namespace hemi::cli::testing {
namespace {

class Export : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write_model();
  }

  /// A command in the test's directory.
  void shell(const std::string& command) const {
    const std::string line = "cd '" + path(".") + "' && " + command + " >shell.txt 2>&1";
    ASSERT_EQ(std::system(line.c_str()), 0) << command << "\n" << content("shell.txt");
  }

  /// What a program prints that was compiled from the exported C file.
  std::string words_of_c(const std::string& compiler) const {
    file("image.c",
         "#include <inttypes.h>\n#include <stdio.h>\n#include \"hemi_registers.h\"\n#include \"image.h\"\n"
         "int main(void) {\n  int i;\n  for (i = 0; i < HEMI_REGISTER_COUNT; ++i)\n"
         "    printf(\"%\" PRId64 \"\\n\", hemi_register_image[i]);\n"
         "  return hemi_parity(hemi_register_image) == hemi_register_image[HEMI_REG_PARITY] ? 0 : 1;\n}\n");
    shell(compiler + " -Wall -Wextra -pedantic -Werror -I" HEMI_BINARY_DIR "/rtl image.c -o image");
    shell("./image");
    return content("shell.txt");
  }
};

TEST_F(Export, AllFormsHoldTheSameWords) {
  good({"export", "hrg.model.json", "--format", "c", "-o", "image.h"});
  good({"export", "hrg.model.json", "--format", "mem", "-o", "registers.mem"});
  good({"export", "hrg.model.json", "--format", "sv", "-o", "image.sv"});
  const std::string c_words = words_of_c("cc -std=c99");
  EXPECT_EQ(words_of_c("c++ -x c++ -std=c++11"), c_words);
  shell("iverilog -g2012 -Wall -s register_image_bench -o bench image.sv " HEMI_SOURCE_DIR
        "/tests/cli/program/register_image_bench.sv");
  EXPECT_EQ(content("shell.txt"), "");
  shell("vvp -n bench");
  std::istringstream simulated(content("shell.txt")), compiled(c_words);
  for (int i = 0; i < config::register_count; ++i) {
    std::string from_memory, from_package;
    std::int64_t raw = 0;
    ASSERT_TRUE(simulated >> from_memory >> from_package && compiled >> raw) << "register " << i;
    const std::string expected = fmt::format("{:014x}", static_cast<std::uint64_t>(raw) & ((1ULL << 54) - 1));
    EXPECT_EQ(from_memory, expected) << config::registers[i].name;
    EXPECT_EQ(from_package, expected) << config::registers[i].name;
  }
  std::string more;
  EXPECT_FALSE(simulated >> more) << more;
}

// The words are the model's: Eq. (21)'s constant in deg/h, its f^2 term and the start of the nco, by hand.
TEST_F(Export, WordsAreThoseOfTheModel) {
  const Outcome outcome = good({"export", "hrg.model.json", "--format", "mem"});
  std::istringstream lines(outcome.out);
  std::vector<std::int64_t> words;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("//", 0) == 0) continue;
    words.push_back(static_cast<std::int64_t>(std::stoull(line.substr(0, 14), nullptr, 16) << 10) >> 10);
  }
  ASSERT_EQ(words.size(), std::size_t{config::register_count});
  EXPECT_EQ(words[config::reg_bias_0], 2 * 8192);
  EXPECT_EQ(words[config::reg_bias_f2], std::llround(0.004 * 64 * 64 * 8192));
  EXPECT_EQ(words[config::reg_control], 1);
  const double f20 = 4424.90095 + 20 * (0.371555556 + 20 * (-9.70238095e-4 + 20 * 1.52777778e-5));
  // The resonator's residual split of 1 mHz moves the driven mode by less than itself.
  EXPECT_NEAR(std::ldexp(1e5 * static_cast<double>(words[config::reg_nco_start]), -48), f20, 1e-3);
}

TEST_F(Export, RefusesWhatItCannotDo) {
  expect_bad({"export", "hrg.model.json"}, {"--format"});
  expect_bad({"export", "hrg.model.json", "--format", "vhdl"}, {"vhdl", "c", "sv", "mem"});
  expect_bad({"export", "none.json", "--format", "c"}, {"none.json"});
  expect_bad({"export", "hrg.model.json", "--format", "c", "-o", "hrg.model.json"}, {"replace"});
  expect_bad({"export", "hrg.model.json", "--format", "c", "-o", "no/such/place.h"}, {"no/such/place.h"});
  file("bare.model.json", "{\"format\": \"hemi-model/1\", \"device\": \"x\", \"scale_factor\": 1.0}");
  expect_bad({"export", "bare.model.json", "--format", "c"},
             {"bare.model.json", "frequency", "hemi calibrate"});
}

// A name that would end a comment, or a line of it.
TEST_F(Export, NamesOfDevicesDoNoHarm) {
  file("odd.model.json", model_text("device", R"("a */ int x; /* // \\ \n #error no")"));
  good({"export", "odd.model.json", "--format", "c", "-o", "image.h"});
  words_of_c("cc -std=c99");
}

}  // namespace
}  // namespace hemi::cli::testing
