// The text of an edit: NAME:key=value,… with NAME a pattern, as --material, --object and --light take it.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/params.h"

namespace nephroid {

/// Does `name` match `pattern`? '*' stands for any run of characters, '?' for any one; case matters.
bool matchesGlob(std::string_view pattern, std::string_view name);

/// "NAME:key=value,…" at the last ':' (names may hold colons, values do not).
/// @param option  how messages name the edit, e.g. "--material"
/// @throws UsageError if there is no ':' or nothing on one side of it
std::pair<std::string, std::string> splitEdit(std::string_view edit, std::string_view option);

/// The values of an edit, checked against `specs`.
/// @param edit  the whole edit, for messages, which begin with "OPTION EDIT: "
/// @throws UsageError
ParamSet parseEditValues(std::vector<ParamSpec> specs, std::string_view option, std::string_view edit,
                         std::string_view values, char separator = ',');

/// "a, b, c" of the distinct names of `items`, in order; "none" if there are none.
template <class List>
std::string listNames(const List& items) {
  std::vector<std::string> names;
  for (const auto& item : items)
    if (std::ranges::find(names, item.name) == names.end()) names.push_back(item.name);
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace nephroid
