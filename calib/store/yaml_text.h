#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

namespace pixelflex::calib {

/// The shortest decimal text that reads back as exactly this number.
[[nodiscard]] std::string yamlNumber(double value);

/// "[1, 2.5]".
[[nodiscard]] std::string yamlList(std::span<const double> values);
[[nodiscard]] std::string yamlList(std::initializer_list<double> values);

/// Plain where YAML would read the same text back wherever it stands, else in double quotes. `text` is UTF-8.
[[nodiscard]] std::string yamlText(std::string_view text);

}  // namespace pixelflex::calib
