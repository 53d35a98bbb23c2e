#include "scene/edit_text.h"

#include <fmt/format.h>

#include "nephroid/error.h"

namespace nephroid {

bool matchesGlob(std::string_view pattern, std::string_view name) {
  // Greedy with one remembered star: a later star makes earlier ones final, so the time is at most the product of
  // lengths.
  std::size_t p = 0, n = 0, star = std::string_view::npos, after_star = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      after_star = n;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n])) {
      ++p, ++n;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      n = ++after_star;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

std::pair<std::string, std::string> splitEdit(std::string_view edit, std::string_view option) {
  const std::size_t colon = edit.rfind(':');
  if (colon == std::string_view::npos || colon == 0 || colon + 1 == edit.size())
    throw UsageError(fmt::format("{} {}: expected NAME:key=value,…", option, edit));
  return {std::string(edit.substr(0, colon)), std::string(edit.substr(colon + 1))};
}

ParamSet parseEditValues(std::vector<ParamSpec> specs, std::string_view option, std::string_view edit,
                         std::string_view values, char separator) {
  ParamSet params(std::move(specs));
  try {
    for (const auto& [key, value] : parseKeyValues(values, separator)) params.set(key, value);
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{} {}: {}", option, edit, error.what()));
  }
  return params;
}

}  // namespace nephroid
