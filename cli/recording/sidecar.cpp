// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/sidecar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "cli/recording/channels.hpp"

namespace hemi::recording {
namespace {

namespace fs = std::filesystem;

void check_content(const Sidecar& sidecar) {
  const std::string format = text_or_empty(sidecar.content, "format", sidecar.path);
  if (!format.empty() && format != kRecordingFormat) {
    throw InputError(
        {.path = sidecar.path}, "is no sidecar of a recording: its format is " + in_quotes(format),
        fmt::format("rename it, or set \"format\" to \"{}\" if it is one after all", kRecordingFormat));
  }
  for (const char* key : {"raw", "columns"}) {
    if (sidecar.content.contains(key) && !sidecar.content[key].is_object()) {
      throw InputError({.path = sidecar.path, .channel = key}, "expected an object", "write {\"...\": ...}");
    }
  }
}

Target mapped_target(const std::string& column, const Json& entry, const Sidecar& sidecar) {
  Target target{.channel = column, .mapped = true};
  const Place place{.path = sidecar.path, .channel = "columns." + column};
  if (entry.is_null()) {
    target.channel.clear();
    return target;
  }
  if (entry.is_string()) {
    target.channel = entry.get<std::string>();
  } else if (entry.is_object()) {
    for (const char* key : {"channel", "name"}) {
      const std::string name = text_or_empty(entry, key, sidecar.path);
      if (!name.empty()) target.channel = name;
    }
    target.scale = number_or(entry, "scale", 1.0, sidecar.path, place.channel);
    target.offset = number_or(entry, "offset", 0.0, sidecar.path, place.channel);
    if (target.scale == 0.0) throw InputError(place, "a scale of 0 leaves nothing", "correct it");
  } else {
    throw InputError(place, "expected a channel name, an object or null",
                     "write \"channel\" or {\"name\": \"channel\", \"scale\": 1, \"offset\": 0}");
  }
  if (find_channel(target.channel) == nullptr) {
    throw InputError(
        place, "there is no channel " + in_quotes(target.channel),
        fmt::format("did you mean '{}'? Or map the column to null", nearest_channel(target.channel).name));
  }
  return target;
}

// "name [unit]" or "name (unit)" in two parts; the unit is empty where there is none.
struct NameAndUnit {
  std::string name, unit;
};

NameAndUnit split_unit(const std::string& text) {
  if (!text.empty() && (text.back() == ']' || text.back() == ')')) {
    const auto open = text.rfind(text.back() == ']' ? '[' : '(');
    const auto last = text.find_last_not_of(" \t", open == 0 ? 0 : open - 1);
    if (open != std::string::npos && open > 0 && last != std::string::npos) {
      return {text.substr(0, last + 1), text.substr(open + 1, text.size() - open - 2)};
    }
  }
  return {text, ""};
}

std::string channel_list() {
  std::string list;
  for (const ChannelInfo& channel : known_channels()) {
    list += (list.empty() ? "" : ", ") + std::string(channel.name);
  }
  return list;
}

Target named_target(const std::string& column, const Sidecar& sidecar, Place place) {
  const auto [name, unit] = split_unit(column);
  place.channel = column;
  const ChannelInfo* channel = find_channel(name);
  if (channel == nullptr) {
    throw InputError(
        place, "unknown channel " + in_quotes(column),
        fmt::format("rename it (nearest: '{}'; known: {}), or map it under \"columns\" in {} (to "
                    "null: ignore)",
                    nearest_channel(name).name, channel_list(), sidecar.path));
  }
  if (!unit.empty()) {
    const std::string remedy = unit_remedy(column, unit, *channel);
    if (!remedy.empty()) {
      throw InputError(place, fmt::format("unit {} where {} is in {}", in_quotes(unit), name, channel->unit),
                       remedy);
    }
  }
  return {.channel = name};
}

}  // namespace

Sidecar read_sidecar(const std::string& recording_path) {
  const fs::path path(recording_path);
  Sidecar sidecar;
  fs::path candidate = fs::path(path).replace_extension(".json");
  std::error_code code;
  if (path.stem().extension() == ".raw" && !fs::exists(candidate, code)) {
    candidate = fs::path(path).replace_extension().replace_extension(".json");
    sidecar.shared = true;
  }
  sidecar.path = candidate.string();
  sidecar.exists = fs::exists(candidate, code);
  if (sidecar.exists) {
    sidecar.content = read_json_object(sidecar.path);
    check_content(sidecar);
  }
  return sidecar;
}

std::vector<Target> resolve_columns(const std::vector<std::string>& names, const Sidecar& sidecar,
                                    const Place& place) {
  const Json columns = sidecar.content.value("columns", Json::object());
  std::vector<Target> targets;
  std::map<std::string, std::string> taken;
  for (const std::string& name : names) {
    const auto entry = columns.find(name);
    targets.push_back(entry == columns.end() ? named_target(name, sidecar, place)
                                             : mapped_target(name, *entry, sidecar));
    const std::string& channel = targets.back().channel;
    if (channel.empty()) continue;
    const auto [first, fresh] = taken.emplace(channel, name);
    if (!fresh) {
      Place doubled = place;
      doubled.channel = channel;
      throw InputError(
          doubled,
          fmt::format("comes from two columns, {} and {}", in_quotes(first->second), in_quotes(name)),
          "remove one, or map it to null under \"columns\" in the sidecar");
    }
  }
  return targets;
}

std::vector<std::string> unused_mappings(const std::vector<std::string>& names, const Sidecar& sidecar) {
  std::vector<std::string> unused;
  const auto columns = sidecar.content.find("columns");
  if (columns == sidecar.content.end()) return unused;
  for (const auto& [name, entry] : columns->items()) {
    if (std::ranges::find(names, name) == names.end()) unused.push_back(name);
  }
  return unused;
}

}  // namespace hemi::recording
