#include "viewer/programs/model_options.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace pixelflex::viewer {

std::vector<double> parseNumbers(const std::string& option, const std::string& text, std::size_t least,
                                 std::size_t most) {
  std::vector<double> numbers;
  std::istringstream stream(text + ',');
  for (std::string word; std::getline(stream, word, ',');) {
    std::size_t used = 0;
    double number = NAN;
    try {
      number = std::stod(word, &used);
    } catch (const std::logic_error&) {
      used = 0;
    }
    if (used == 0 || used != word.size() || !std::isfinite(number)) {
      throw std::invalid_argument(option + " " + text + ": \"" + word + "\" is not a number");
    }
    numbers.push_back(number);
  }
  if (numbers.size() >= least && numbers.size() <= most) return numbers;
  const std::string wanted =
      least == most ? std::to_string(least) : std::to_string(least) + " to " + std::to_string(most);
  throw std::invalid_argument(option + " " + text + ": needs " + wanted + " numbers with commas between");
}

ModelView viewOf(const ModelCommand& command, const WallWindow& window) {
  ModelView view{.window = window,
                 .viewer = centredViewer(window),
                 .pose = command.pose,
                 .wireframe = command.wireframe,
                 .axes = command.axes,
                 .cut = command.cut};
  if (command.eye) view.viewer.eye = *command.eye;
  if (command.eyeDistance) view.viewer.eyeDistance = *command.eyeDistance;
  return view;
}

}  // namespace pixelflex::viewer
