/* SPDX-License-Identifier: Apache-2.0 */
#define VIEW view_of_c
#include "tests/rtl/registers/header_check.inc"
