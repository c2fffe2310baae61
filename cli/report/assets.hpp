// SPDX-License-Identifier: Apache-2.0
// The page's style sheet and scripts; the build puts them into the program (embed.cmake).
#ifndef HEMI_CLI_REPORT_ASSETS_HPP
#define HEMI_CLI_REPORT_ASSETS_HPP

#include <string_view>

namespace hemi::report::assets {

extern const std::string_view uplot_js;
extern const std::string_view uplot_css;
extern const std::string_view page_js;
extern const std::string_view page_css;

}  // namespace hemi::report::assets

#endif  // HEMI_CLI_REPORT_ASSETS_HPP
