// What is put into a page of HTML.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace nephroid {

/// Text that may stand between tags and in quoted attributes, whatever it holds: names of files and metadata come from
/// anywhere. What is no UTF-8, or a control character, becomes U+FFFD.
std::string escapeHtml(std::string_view text);

/// "data:image/png;base64,…"
std::string makePngUri(std::span<const std::byte> png);

/// Replaces each {{name}} in `page` by its value, once: braces in values mean nothing.
/// @throws InternalError for a name that has no value
std::string fillTemplate(std::string_view page, const std::map<std::string, std::string, std::less<>>& values);

}  // namespace nephroid
