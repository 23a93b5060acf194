// A page that needs nothing but itself: sections of HTML, figures that stand still as SVG and come alive by script, and
// the numbers that they are drawn from. Internal to io.
#pragma once

#include "io/json.hpp"
#include "io/markup.hpp"
#include "io/svg_plot.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace grandamp::report {

/// JSON that cannot end the script element that it stands in.
std::string embedded(const Json& json);

/// All cells are text, not HTML; the first of a row is its header.
std::string table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows,
                  std::string_view caption = {});
using Facts = std::vector<std::pair<std::string, std::string>>;
/// Names and what they stand for; both text. Entries without a text are left out.
std::string facts(const Facts& entries);

struct Figure {
  std::string name;    ///< of its picture: letters, digits and underscores
  std::string title;   ///< text
  std::string caption; ///< text, may be empty
  std::string svg;     ///< the still picture
  Json live;           ///< what the script draws in its place, by "kind"; null: nothing
  std::string numbers; ///< HTML: the same as a table
};

/// Both pictures of a plot: SVG, and the same for the script.
Figure figure_of(const Plot& plot, std::string name, std::string caption, std::string numbers);

class Page {
public:
  Page(std::string title, std::string subtitle) : title_(std::move(title)), subtitle_(std::move(subtitle)) {}

  /// A section that the page's contents list; what is added next stands in it.
  void section(std::string_view id, std::string_view heading);
  void add(std::string_view html) { body_ += html; }
  void add(Figure figure);
  /// Bytes for the script, by name.
  void add_data(std::string_view name, std::span<const std::byte> bytes);
  Json& facts() { return script_facts_; }

  /// The whole page.
  std::string text() const;
  /// report.html, and the still pictures in report/. Throws FileError. Returns the path of the page.
  std::filesystem::path write(const std::filesystem::path& folder) const;

private:
  std::string title_, subtitle_, body_, contents_, data_;
  bool in_section_ = false;
  std::vector<Figure> figures_;
  Json script_facts_ = Json::object();
};

} // namespace grandamp::report
