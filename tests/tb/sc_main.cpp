// SPDX-License-Identifier: Apache-2.0
// GoogleTest's main for programs that link SystemC, whose library brings a main of its own.
#include <gtest/gtest.h>

extern "C" int sc_main(int, char**) {
  return 0;
}

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
