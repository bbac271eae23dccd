#include "framework/view/page.hpp"

#include "framework/base/text/escape.hpp"
#include "framework/view/assets.hpp"
#include "framework/view/picture.hpp"
#include "framework/view/scene_json.hpp"

namespace twinmap::view {
namespace {

/// No text of an experiment ends the element that holds it.
std::string protect(std::string json) {
  for (std::size_t at = json.find("</"); at != std::string::npos; at = json.find("</", at + 3)) {
    json.replace(at, 2, "<\\/");
  }
  return json;
}

}  // namespace

std::string makePage(const Scene& scene) {
  const std::string title = escapeHtml(scene.name);
  return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         title + "</title>\n<style>\n" + std::string(getStyle()) + "</style>\n</head>\n<body>\n<main>\n<h1>" +
         title +
         "</h1>\n<div id=\"stage\" tabindex=\"0\" role=\"application\" aria-label=\"the mechanism, "
         "moving\"></div>\n"
         "<div id=\"picture\">" +
         makePicture(scene) +
         "</div>\n<div id=\"controls\" role=\"group\" aria-label=\"controls\"></div>\n<div "
         "id=\"plots\"></div>\n"
         "<noscript>The picture moves with JavaScript.</noscript>\n</main>\n"
         "<script type=\"application/json\" id=\"scene\">" +
         protect(makeSceneJson(scene)) + "</script>\n<script>" + std::string(getScript()) +
         "</script>\n</body>\n</html>\n";
}

}  // namespace twinmap::view
