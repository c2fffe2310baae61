// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/partial_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "cli/recording/error.hpp"

namespace hemi::recording {
namespace fs = std::filesystem;

PartialFile::PartialFile(const std::string& path) : path_(path) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (fs::is_directory(status)) {
    throw OutputError(path, "is a directory", "name a file inside it");
  }
  if (!fs::exists(status) || fs::is_regular_file(status)) {
    // Through symbolic links, so that the rename replaces the file and not the link to it.
    const fs::path target = fs::weakly_canonical(path, code);
    if (!code) path_ = target.string();
    partial_ = path_ + ".partial";
    guard_ = std::make_unique<RemovedOnSignal>(partial_);
  }
  const std::string& opened = partial_.empty() ? path_ : partial_;
  descriptor_ = ::open(opened.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(errno);
}

PartialFile::~PartialFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!committed_ && !partial_.empty()) ::unlink(partial_.c_str());
}

void PartialFile::fail(int reason) const {
  const char* remedy = "check the directory";
  if (reason == ENOSPC || reason == EDQUOT || reason == EFBIG) {
    remedy = "free some space or write elsewhere; nothing was left behind";
  } else if (reason == ENOENT) {
    remedy = "make the directory first";
  } else if (reason == EACCES || reason == EROFS || reason == EPERM) {
    remedy = "write to a directory in which this user may write";
  }
  throw OutputError(path_, std::strerror(reason), remedy);
}

void PartialFile::write(std::string_view bytes) {
  // Blocks, so that an interrupt of a long write is seen.
  constexpr std::size_t kBlock = std::size_t{1} << 24;
  while (!bytes.empty()) {
    check_interrupt();
    const ssize_t written = ::write(descriptor_, bytes.data(), std::min(bytes.size(), kBlock));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void PartialFile::finish() {
  if (descriptor_ < 0) return;
  const bool regular = !partial_.empty();
  const int sync_reason = regular && ::fsync(descriptor_) != 0 ? errno : 0;
  const int close_reason = ::close(descriptor_) != 0 ? errno : 0;
  descriptor_ = -1;
  if (sync_reason != 0 && sync_reason != EINVAL) fail(sync_reason);
  if (close_reason != 0) fail(close_reason);
}

void PartialFile::commit() {
  finish();
  if (!partial_.empty() && std::rename(partial_.c_str(), path_.c_str()) != 0) fail(errno);
  committed_ = true;
}

}  // namespace hemi::recording
