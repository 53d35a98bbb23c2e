// Declaring options: every option is declared once, with its facts in one form, and checked where it is parsed.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

// CLI11 takes seconds to compile: the files that declare options do without its header.
namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace nephroid::cli {

/// What `--help`, the manual page and the shell completion say of an option.
struct OptionText {
  std::string text;           ///< one sentence or two, with full stop
  std::string default_value;  ///< as the user would write it, or words ("none")
  std::string range;          ///< "1 to 16384", or the choices separated by '|'; empty: any
  std::string unit;           ///< "px", "s", "deg"; empty: a pure number or a name
};

/// "TEXT [default: D; range: R; unit: U]", the one form of every help text.
std::string describe(const OptionText& text);

/// What is wrong with a value, as the user wrote it; nothing if it will do.
using Check = std::function<std::string(const std::string&)>;

/// Accepts finite numbers in [lower, upper].
Check checkNumber(double lower, double upper);

/// Accepts one of `choices`; otherwise names them, and the nearest.
Check checkChoice(std::vector<std::string> choices);

/// Heading of the options that follow, in the help.
void beginGroup(CLI::App& app, const char* name);
void endGroup(CLI::App& app);

/// An option, or an argument where `flags` have no dash, with a value of type T (string, int, float, double,
/// optional<float>).
template <class T>
void addValue(CLI::App& app, const std::string& flags, T& target, const std::string& value_name, const OptionText& text,
              const Check& check = {});

/// An option whose value `parse` takes. @param parse  may throw UsageError
void addParsed(CLI::App& app, const std::string& flags, const std::function<void(const std::string&)>& parse,
               const std::string& value_name, const OptionText& text);

/// An option that may be repeated; each time it takes one value.
void addList(CLI::App& app, const std::string& flags, std::vector<std::string>& target, const std::string& value_name,
             const OptionText& text);

/// Arguments of any number.
void addArguments(CLI::App& app, const std::string& name, std::vector<std::string>& target,
                  const std::string& value_name, const OptionText& text);

void addSwitch(CLI::App& app, const std::string& flags, bool& target, const std::string& text);

/// Whether the command line or the state file sets the option, once they are read. @param name  with its dashes
bool isGiven(const CLI::App& app, const std::string& name);

/// A count such as 64, 1e6, 500k or 2.5M.
void addCount(CLI::App& app, const std::string& flags, std::uint64_t& target, const OptionText& text);

/// @param name  of the option, for messages
/// @return      the count that `text` means: digits, a decimal number, with exponent or one of the suffixes k, M, G
/// @throws UsageError if it is no number, negative, no whole number or above 2^53
std::uint64_t parseCount(std::string_view name, const std::string& text);

/// Width and height in pixels.
struct Size {
  int width = 0, height = 0;
};

/// Largest width and height: what OpenEXR and PNG readers everywhere still open, and 3 GiB per float layer.
inline constexpr int kMaxSide = 16384;

/// @return "1024x768" as numbers
/// @throws UsageError
Size parseSize(std::string_view name, const std::string& text);

/// "a,b,c" as its pieces; empty pieces are dropped.
std::vector<std::string> splitList(std::string_view text, char separator = ',');

/// Gives every option of `app` that the command line did not set the value that the JSON object in the file at `path`
/// has under the option's long name. A list stands for a repeated option; an object for repeated "key=value".
/// @throws InputError naming the file and the key
void applyStateFile(CLI::App& app, const std::string& path);

}  // namespace nephroid::cli
