// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "cli/recording/channels.hpp"
#include "cli/recording/csv_file.hpp"
#include "cli/recording/hdf5_file.hpp"
#include "cli/recording/matlab_file.hpp"

namespace hemi::recording {
namespace {

void convert(const Target& target, std::vector<double>& values) {
  if (target.scale == 1.0 && target.offset == 0.0) return;
  for (double& value : values) value = target.scale * value + target.offset;
}

// A mapping of a column that is not there may be a typing error. A shared sidecar speaks of two files.
void note_unused(const std::vector<std::string>& names, const Sidecar& sidecar,
                 std::vector<std::string>& notes) {
  if (sidecar.shared) return;
  for (const std::string& name : unused_mappings(names, sidecar)) {
    notes.push_back(fmt::format("{}: columns.{}: the recording has no such column", sidecar.path, name));
  }
}

Table load_csv(const std::string& path, const Sidecar& sidecar) {
  std::vector<Target> targets;
  std::vector<std::string> notes;
  Table table = read_csv(path, [&](const std::vector<std::string>& names, const Place& place) {
    targets = resolve_columns(names, sidecar, place);
    note_unused(names, sidecar, notes);
    std::vector<bool> wanted;
    wanted.reserve(targets.size());
    for (const Target& target : targets) wanted.push_back(!target.channel.empty());
    return wanted;
  });
  std::erase_if(targets, [](const Target& target) { return target.channel.empty(); });
  for (std::size_t i = 0; i < targets.size(); ++i) {
    table.columns[i].name = targets[i].channel;
    convert(targets[i], table.columns[i].values);
  }
  table.notes.insert(table.notes.end(), notes.begin(), notes.end());
  return table;
}

// Attributes of the file below, those of the group raw and the sidecar on top: the sidecar is what a person
// corrects most easily.
Json merged_metadata(const StoredGroup& group, const Sidecar& sidecar, const std::string& path) {
  Json metadata = group.file_attributes;
  for (const char* key : {"raw", "columns"}) {
    if (metadata.contains(key) && !metadata[key].is_object()) {
      throw InputError({.path = path, .channel = key}, "the attribute is no JSON object",
                       "correct or remove it");
    }
  }
  for (const auto& [key, value] : group.group_attributes.items()) metadata["raw"][key] = value;
  for (const auto& [key, value] : sidecar.content.items()) {
    if (key == "raw") {
      metadata["raw"].update(value);
    } else {
      metadata[key] = value;
    }
  }
  return metadata;
}

void check_units(const StoredArray& dataset, const Target& target, const std::string& path) {
  const ChannelInfo* channel = find_channel(target.channel);
  if (target.mapped || dataset.unit.empty() || channel == nullptr) return;
  const std::string remedy = unit_remedy(dataset.name, dataset.unit, *channel);
  if (remedy.empty()) return;
  throw InputError({.path = path, .channel = dataset.name},
                   fmt::format("attribute unit is {} where {} is in {}", in_quotes(dataset.unit),
                               channel->name, channel->unit),
                   remedy);
}

void check_values(const Table& table) {
  for (const Column& column : table.columns) {
    if (column.values.size() != table.rows()) {
      throw InputError({.path = table.path, .channel = column.name},
                       fmt::format("has {} values where {} has {}", column.values.size(),
                                   table.columns.front().name, table.rows()),
                       "store channels of equal length, or map one to null under \"columns\" in the sidecar");
    }
    const auto infinite = std::ranges::find_if(column.values, [](double x) { return std::isinf(x); });
    if (infinite != column.values.end()) {
      throw InputError(table.place(static_cast<std::size_t>(infinite - column.values.begin()), column.name),
                       "is infinite", "store NaN where the value is missing");
    }
  }
  if (table.rows() == 0) {
    throw InputError({.path = table.path}, "no channel with values",
                     "store one-dimensional arrays named as the channels at the top level");
  }
}

bool is_metadata_name(const std::string& name) {
  return name == "sample_rate_hz" || name == "full_scale_lsb";
}

StoredGroup read_arrays(const std::string& path, FileKind kind, bool raw, const ArrayChooser& chooser) {
  return kind == FileKind::kMatlab ? read_matlab(path, raw, chooser) : read_hdf5(path, raw, chooser);
}

// A file may carry its sidecar inside: attributes first, so that `columns` among them count as well.
Sidecar with_attributes(const std::string& path, FileKind kind, Sidecar sidecar, bool raw) {
  const StoredGroup group = read_arrays(path, kind, raw, [](const std::string& name) {
    return is_metadata_name(name) ? ArrayUse::kAttribute : ArrayUse::kIgnore;
  });
  sidecar.content = merged_metadata(group, sidecar, path);
  return sidecar;
}

Table load_arrays(const std::string& path, FileKind kind, const Sidecar& file_sidecar, bool raw) {
  const Sidecar sidecar = with_attributes(path, kind, file_sidecar, raw);
  const Json columns = sidecar.content.value("columns", Json::object());
  StoredGroup group = read_arrays(path, kind, raw, [&columns](const std::string& name) {
    const bool ignored = is_metadata_name(name) || (columns.contains(name) && columns[name].is_null());
    return ignored ? ArrayUse::kIgnore : ArrayUse::kChannel;
  });
  std::vector<std::string> names;
  for (const StoredArray& dataset : group.arrays) names.push_back(dataset.name);
  const std::vector<Target> targets = resolve_columns(names, sidecar, {.path = path});
  Table table{.path = path, .metadata = sidecar.content, .notes = group.notes};
  for (std::size_t i = 0; i < targets.size(); ++i) {
    check_units(group.arrays[i], targets[i], path);
    table.columns.push_back({targets[i].channel, std::move(group.arrays[i].values)});
    convert(targets[i], table.columns.back().values);
  }
  check_values(table);
  return table;
}

std::string lower_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension;
}

}  // namespace

const Column* Table::find(std::string_view name) const {
  const auto found = std::ranges::find(columns, name, &Column::name);
  return found == columns.end() ? nullptr : &*found;
}

Place Table::place(std::size_t row, std::string channel) const {
  if (first_line > 0) return {.path = path, .line = first_line + row, .channel = std::move(channel)};
  return {.path = path, .row = row + 1, .channel = std::move(channel)};
}

FileKind file_kind(const std::string& path) {
  require_readable(path);
  const std::string extension = lower_extension(path);
  const auto is_one_of = [&extension](std::initializer_list<std::string_view> list) {
    return std::ranges::find(list, extension) != list.end();
  };
  if (is_one_of({".csv", ".txt"})) return FileKind::kCsv;
  if (is_one_of({".h5", ".hdf5", ".hdf"})) return FileKind::kHdf5;
  if (extension == ".mat") return FileKind::kMatlab;
  if (is_one_of({".wav", ".flac", ".aif", ".aiff", ".w64", ".rf64", ".caf"})) return FileKind::kSound;
  // A pipe has neither a name nor a second reading: it can only be text.
  if (!std::filesystem::is_regular_file(path)) return FileKind::kCsv;
  char head[8] = {};
  std::ifstream(path, std::ios::binary).read(head, sizeof head);
  const std::string_view magic(head, sizeof head);
  if (magic == "\x89HDF\r\n\x1a\n") return FileKind::kHdf5;
  if (magic.starts_with("MATLAB")) return FileKind::kMatlab;
  for (const char* sound : {"RIFF", "RF64", "fLaC", "FORM", "OggS", "caff"}) {
    if (magic.starts_with(sound)) return FileKind::kSound;
  }
  return FileKind::kCsv;
}

Table load_channels(const std::string& path, FileKind kind, const Sidecar& sidecar, bool raw) {
  if (kind != FileKind::kCsv) return load_arrays(path, kind, sidecar, raw);
  Table table = load_csv(path, sidecar);
  table.metadata = sidecar.content;
  return table;
}

std::vector<std::string> column_names(const std::string& path, FileKind kind) {
  if (kind == FileKind::kMatlab) return matlab_names(path);
  return kind == FileKind::kHdf5 ? hdf5_dataset_names(path) : read_csv_header(path);
}

}  // namespace hemi::recording
