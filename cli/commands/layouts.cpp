// regather layouts -- the orders and the records that a layout is made of.
#include <fmt/format.h>

#include <memory>

#include "cli/command.h"
#include "cli/commands.h"
#include "replay/layouts/catalogue.h"
#include "results/table.h"

namespace regather::cli {
namespace {

struct LayoutsOptions {};

void list_layouts(const LayoutsOptions&, const Console& console) {
    using results::Align;
    results::Table orders({{"order", Align::left}, {"how memory holds the elements", Align::left}});
    for (const replay::LayoutOrder& order : replay::layout_orders())
        orders.add({std::string(order.name), std::string(order.summary)});
    results::Table records({{"record", Align::left},
                            {"bytes", Align::right},
                            {"read", Align::right},
                            {"a photon", Align::left}});
    for (const replay::PhotonRecord& record : replay::photon_records())
        records.add({std::string(record.name),
                     record.stride_bytes == 0 ? "" : fmt::format("{}", record.stride_bytes),
                     record.used_bytes == 0 ? "" : fmt::format("{}", record.used_bytes),
                     std::string(record.summary)});
    results::Table triangles({{"record", Align::left},
                              {"bytes", Align::right},
                              {"a triangle, in structures for rays", Align::left}});
    for (const replay::TriangleRecord& record : replay::triangle_records())
        triangles.add(
            {std::string(record.name), fmt::format("{}", record.bytes), std::string(record.summary)});
    results::Table parameters({{"parameter", Align::left}, {"default", Align::left}, {"what", Align::left}});
    for (const trace::Parameter& parameter : replay::layout_parameters())
        parameters.add(
            {std::string(parameter.name), std::string(parameter.default_value), std::string(parameter.help)});
    console.print("A layout is ORDER-RECORD:parameter=value,...\n\n{}\n{}\n{}\n{}", results::text_of(orders),
                  results::text_of(records), results::text_of(triangles), results::text_of(parameters));
}

}  // namespace

void add_layouts(Command& command) {
    command.footer(
        "Examples:\n"
        "  regather layouts             # their orders and records, for:\n"
        "  regather replay out/room/trace --order naive hilbert --layout heap-20 van-emde-boas-20 "
        "clusters-32:line=128");
    command.action(std::make_shared<LayoutsOptions>(), list_layouts);
}

}  // namespace regather::cli
