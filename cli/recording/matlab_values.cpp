// SPDX-License-Identifier: Apache-2.0
#include "cli/recording/matlab_values.hpp"

#include <algorithm>
#include <cstdint>

#include "cli/recording/matlab_version.hpp"
#include "cli/recording/stored_text.hpp"

namespace hemi::recording {
namespace {

bool is_vector(const matvar_t& variable) {
  return variable.rank == 2 && (variable.dims[0] <= 1 || variable.dims[1] <= 1);
}

template <class T>
std::vector<double> widened(const matvar_t& variable, std::size_t count) {
  const auto* values = static_cast<const T*>(variable.data);
  return {values, values + count};
}

// The library takes pointers that it does not write through.
std::size_t field_count(const matvar_t& variable) {
  return variable.class_type == MAT_C_STRUCT ? Mat_VarGetNumberOfFields(const_cast<matvar_t*>(&variable)) : 0;
}

}  // namespace

double claimed_elements(const matvar_t& variable) {
  double count = 1.0;
  for (int i = 0; i < variable.rank; ++i) count *= static_cast<double>(variable.dims[i]);
  return count;
}

std::string unusable_kind(const matvar_t& variable) {
  switch (variable.class_type) {
    case MAT_C_STRUCT:
      return "struct";
    case MAT_C_CELL:
      return "cell array";
    case MAT_C_SPARSE:
      return "sparse matrix";
    case MAT_C_CHAR:
      return "text";
    case MAT_C_OBJECT:
    case MAT_C_FUNCTION:
    case MAT_C_OPAQUE:
    case MAT_C_EMPTY:
      return kMatlabObject;
    default:
      break;
  }
  if (variable.isComplex != 0) return "vector of complex numbers";
  return is_vector(variable) ? "" : "matrix";
}

double claimed_bytes(const matvar_t& variable) {
  constexpr double kTag_bytes = 8.0;  // of each element at least
  const double count = claimed_elements(variable);
  auto* open = const_cast<matvar_t*>(&variable);
  if (variable.class_type != MAT_C_STRUCT && variable.class_type != MAT_C_CELL) {
    const double bytes = count * static_cast<double>(Mat_SizeOfClass(static_cast<int>(variable.class_type)));
    return variable.isComplex != 0 ? 2.0 * bytes : bytes;
  }
  const bool structure = variable.class_type == MAT_C_STRUCT;
  double bytes = count * kTag_bytes * static_cast<double>(structure ? field_count(variable) : 1);
  // More elements than anything here reads: their tags alone decide.
  constexpr double kMostElements = 1e4;
  if (!(count <= kMostElements) || variable.data == nullptr) return bytes;
  const auto elements = static_cast<std::size_t>(count);
  for (std::size_t i = 0; i < elements; ++i) {
    for (std::size_t k = 0; k < (structure ? field_count(variable) : 1); ++k) {
      const matvar_t* inner =
          structure ? Mat_VarGetStructFieldByIndex(open, k, i) : Mat_VarGetCell(open, static_cast<int>(i));
      if (inner != nullptr) bytes += claimed_bytes(*inner);
    }
  }
  return bytes;
}

std::optional<std::vector<double>> vector_values(const matvar_t& variable) {
  const auto count = static_cast<std::size_t>(claimed_elements(variable));
  if (count == 0) return std::vector<double>{};
  if (variable.data == nullptr) return std::nullopt;
  switch (variable.class_type) {
    case MAT_C_DOUBLE:
      return widened<double>(variable, count);
    case MAT_C_SINGLE:
      return widened<float>(variable, count);
    case MAT_C_INT8:
      return widened<std::int8_t>(variable, count);
    case MAT_C_UINT8:
      return widened<std::uint8_t>(variable, count);
    case MAT_C_INT16:
      return widened<std::int16_t>(variable, count);
    case MAT_C_UINT16:
      return widened<std::uint16_t>(variable, count);
    case MAT_C_INT32:
      return widened<std::int32_t>(variable, count);
    case MAT_C_UINT32:
      return widened<std::uint32_t>(variable, count);
    case MAT_C_INT64:
      return widened<std::int64_t>(variable, count);
    case MAT_C_UINT64:
      return widened<std::uint64_t>(variable, count);
    default:
      return std::nullopt;
  }
}

std::string char_text(const matvar_t& variable) {
  if (variable.data == nullptr || !is_vector(variable)) return {};
  // In UTF-8 there may be more bytes than characters.
  const std::size_t count =
      variable.nbytes / std::max<std::size_t>(Mat_SizeOf(variable.data_type), std::size_t{1});
  switch (variable.data_type) {
    case MAT_T_UTF16:
    case MAT_T_UINT16:
    case MAT_T_INT16:
      return utf8_of_utf16({static_cast<const std::uint16_t*>(variable.data), count});
    case MAT_T_UTF8:
      return {static_cast<const char*>(variable.data), count};
    case MAT_T_UINT8:
    case MAT_T_INT8: {
      const auto* bytes = static_cast<const std::uint8_t*>(variable.data);
      return utf8_of_utf16(std::vector<std::uint16_t>(bytes, bytes + count));
    }
    default:
      return {};
  }
}

Json matlab_value(const matvar_t& variable, int depth) {
  constexpr int kDeepest = 8;
  if (depth > kDeepest) return nullptr;
  if (variable.class_type == MAT_C_CHAR) return text_value(char_text(variable));
  if (variable.class_type == MAT_C_STRUCT) {
    Json object = Json::object();
    if (claimed_elements(variable) != 1.0) return nullptr;
    char* const* names = Mat_VarGetStructFieldnames(&variable);
    for (std::size_t i = 0; names != nullptr && i < field_count(variable); ++i) {
      const matvar_t* field = Mat_VarGetStructFieldByIndex(const_cast<matvar_t*>(&variable), i, 0);
      if (names[i] != nullptr && field != nullptr) object[names[i]] = matlab_value(*field, depth + 1);
    }
    return object;
  }
  if (!unusable_kind(variable).empty()) return nullptr;
  const auto values = vector_values(variable);
  if (!values) return nullptr;
  if (values->size() != 1) return Json(*values);
  return variable.isLogical != 0 ? Json(values->front() != 0.0) : Json(values->front());
}

}  // namespace hemi::recording
