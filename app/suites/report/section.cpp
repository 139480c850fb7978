#include "app/suites/report/section.h"

namespace icloth {
namespace {

using Json = nlohmann::ordered_json;

Json table_to_json(const Table& table) {
  return {{"name", table.name()},
          {"title", table.title()},
          {"columns", table.columns()},
          {"rows", table.rows()}};
}

Table table_from_json(const Json& json) {
  Table table(json.at("name"), json.at("title"),
              json.at("columns").get<std::vector<std::string>>());
  for (const Json& row : json.at("rows")) table.add(row.get<std::vector<std::string>>());
  return table;
}

Json plot_to_json(const Plot& plot) {
  Json json = {{"title", plot.title},    {"x", plot.x_label},   {"y", plot.y_label},
               {"log_x", plot.log_x},    {"log_y", plot.log_y}, {"markers", plot.markers},
               {"series", Json::array()}};
  for (const Series& series : plot.series)
    json["series"].push_back(
        {{"name", series.name}, {"points", series.points}, {"line", series.line}});
  return json;
}

Plot plot_from_json(const Json& json) {
  Plot plot{.title = json.at("title"),
            .x_label = json.at("x"),
            .y_label = json.at("y"),
            .log_x = json.at("log_x"),
            .log_y = json.at("log_y"),
            .markers = json.at("markers"),
            .series = {}};
  for (const Json& series : json.at("series"))
    plot.series.push_back({series.at("name"),
                           series.at("points").get<std::vector<std::pair<double, double>>>(),
                           series.at("line")});
  return plot;
}

}  // namespace

Json section_to_json(const Section& section) {
  Json json = {{"heading", section.heading},
               {"texts", section.texts},
               {"tables", Json::array()},
               {"plots", Json::array()}};
  for (const Table& table : section.tables) json["tables"].push_back(table_to_json(table));
  for (const Plot& plot : section.plots) json["plots"].push_back(plot_to_json(plot));
  return json;
}

Section section_from_json(const Json& json) {
  Section section;
  section.heading = json.at("heading");
  section.texts = json.at("texts").get<std::vector<std::string>>();
  for (const Json& table : json.at("tables")) section.tables.push_back(table_from_json(table));
  for (const Json& plot : json.at("plots")) section.plots.push_back(plot_from_json(plot));
  return section;
}

}  // namespace icloth
