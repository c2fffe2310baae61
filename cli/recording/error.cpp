// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace hemi::recording {
namespace {

std::string describe(const Place& place) {
  std::string text = place.path;
  if (place.line > 0) text += fmt::format(":{}", place.line);
  if (place.row > 0) text += fmt::format(": row {}", place.row);
  if (!place.channel.empty()) text += (text.empty() ? "" : ": ") + place.channel;
  return text.empty() ? text : text + ": ";
}

std::string with_remedy(std::string_view problem, std::string_view remedy) {
  return remedy.empty() ? std::string(problem) : fmt::format("{}; {}", problem, remedy);
}

}  // namespace

InputError::InputError(const Place& place, std::string_view problem, std::string_view remedy)
    : std::runtime_error(describe(place) + with_remedy(problem, remedy)) {}

OutputError::OutputError(const std::string& path, std::string_view problem, std::string_view remedy)
    : std::runtime_error(path + ": " + with_remedy(problem, remedy)) {}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 48;
  std::string out = "'";
  for (const char c : text.substr(0, kLongest)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) {
      out += fmt::format("\\x{:02x}", byte);
    } else {
      out += c;
    }
  }
  return out + (text.size() > kLongest ? "...'" : "'");
}

void require_readable(const std::string& path) {
  struct stat status {};
  int reason = ::stat(path.c_str(), &status) != 0 ? errno : 0;
  if (reason == 0 && S_ISDIR(status.st_mode)) {
    throw InputError({.path = path}, "is a directory", "name a file inside it");
  }
  // A pipe can be opened only once, by its reader.
  if (reason == 0 && S_ISREG(status.st_mode)) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) reason = errno;
    if (descriptor >= 0) ::close(descriptor);
    if (descriptor >= 0 && status.st_size == 0) {
      throw InputError({.path = path}, "the file is empty", "record or export it again");
    }
  }
  if (reason == 0) return;
  const char* remedy = reason == ENOENT   ? "check the name and the working directory"
                       : reason == EACCES ? "make the file readable for this user"
                                          : "check the file";
  throw InputError({.path = path}, std::strerror(reason), remedy);
}

}  // namespace hemi::recording
