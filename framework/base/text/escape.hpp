#pragma once

#include <string>

namespace twinmap {

/// Texts from experiment files, made safe where they are shown.
std::string escapeCsv(const std::string& text);       ///< RFC 4180: quoted where it has , " or a line break
std::string quoteForShell(const std::string& text);   ///< as one word of a POSIX shell; as it is if plain
std::string escapeMarkdown(const std::string& text);  ///< in a table cell
std::string escapeLatex(const std::string& text);
std::string escapeHtml(const std::string& text);  ///< in text, in attribute values and in SVG

}  // namespace twinmap
