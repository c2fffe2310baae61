// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "cli/recording/interrupt.hpp"

namespace hemi::recording {

/// A file that appears whole or not at all: bytes go to NAME.partial, commit() gives it its name, anything
/// else (exception, signal) removes it. A target that is no regular file (/dev/stdout, a pipe) is written
/// directly, for it can be neither renamed nor removed. Every failure throws OutputError.
class PartialFile {
 public:
  explicit PartialFile(const std::string& path);
  ~PartialFile();
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  void write(std::string_view bytes);
  /// Everything on the disk and closed, still under the partial name: a full disk shows here at the latest.
  void finish();
  /// finish(), then the final name.
  void commit();

 private:
  [[noreturn]] void fail(int reason) const;

  std::string path_;
  std::string partial_;  // empty: direct
  std::unique_ptr<RemovedOnSignal> guard_;
  int descriptor_ = -1;
  bool committed_ = false;
};

}  // namespace hemi::recording
