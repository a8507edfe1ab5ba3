#pragma once

#include <string>

#include "option_flags.hpp"

namespace isotherm::apps {

/// Whether the page can show `document`: a report document of this version with every member
/// there, of its type, of the length that the others ask for, and with every position inside
/// what it points into.
/// @throws ParseError naming `path` and the member that is not so
void check_report(const Json& document, const std::string& path);

/// Whether two documents that check_report() passed are on the same graph: of one kind, with
/// the same nodes, and with candidates that join the same ones in the same order.
/// @throws ParseError naming `path`, of `second`, and what differs
void check_same_graph(const Json& first, const Json& second, const std::string& path);

}  // namespace isotherm::apps
