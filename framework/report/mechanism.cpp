#include "framework/report/mechanism.hpp"

#include <stdexcept>

#include "framework/report/html.hpp"
#include "framework/view/picture.hpp"

namespace twinmap {

void addMechanism(const ExperimentSpec& experiment, const std::string& view, Page& page) {
  std::string picture;
  try {
    picture = view::makePicture(experiment);
  } catch (const std::runtime_error& error) {
    page.opening =
        makeParagraph("The mechanism is not drawn: " + std::string(error.what()), "class=\"quiet\"");
    return;
  }
  if (!picture.empty()) {
    page.opening = makeElement(
        "figure",
        picture + makeElement("figcaption", "As it begins, at the centre of the bounds. It moves in " +
                                                makeElement("code", escapeHtml(view))),
        "id=\"mechanism\"");
  }
}

}  // namespace twinmap
