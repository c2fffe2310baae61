// SPDX-License-Identifier: Apache-2.0
#ifndef HEMI_CLI_WAVES_FILE_HPP
#define HEMI_CLI_WAVES_FILE_HPP

#include <filesystem>
#include <fstream>
#include <string>

#include "cli/recording/error.hpp"
#include "cli/recording/interrupt.hpp"

namespace hemi::cli {

/// Waves are written to NAME.partial and get their name when the work is through; interrupted work leaves
/// none. An empty path stands for no waves. OutputError where the file cannot be written.
class WavesFile {
 public:
  explicit WavesFile(const std::string& path)
      : path_(path), partial_(path.empty() ? "" : path + ".partial"), guard_(partial_) {
    if (path_.empty()) return;
    std::error_code code;
    if (std::filesystem::is_directory(path_, code) || !std::ofstream(partial_)) refuse();
  }
  WavesFile(const WavesFile&) = delete;
  WavesFile& operator=(const WavesFile&) = delete;
  ~WavesFile() {
    std::error_code code;
    if (!partial_.empty()) std::filesystem::remove(partial_, code);
  }

  const std::string& partial() const { return partial_; }

  /// The file must be closed.
  void commit() const {
    if (path_.empty()) return;
    std::error_code code;
    std::filesystem::rename(partial_, path_, code);
    if (code) refuse();
  }

 private:
  [[noreturn]] void refuse() const {
    throw recording::OutputError(path_, "cannot be written", "name a file in a directory that is there");
  }

  std::string path_;
  std::string partial_;
  recording::RemovedOnSignal guard_;
};

}  // namespace hemi::cli

#endif  // HEMI_CLI_WAVES_FILE_HPP
