// The keys of a scene file, table by table: for messages that say what was meant.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace grandamp {

/// The keys of a table by its dotted key ("" the root, "granules" any population); empty: no such table.
std::span<const std::string_view> keys_of_table(std::string_view table);

/// "[enclosure]" for "diameter" and so on, of all tables that have the key but `table`; empty: no other has it.
std::string other_tables_with(std::string_view key, std::string_view table);

/// The table that a path is of: "granules.0" is "granules".
std::string table_of_path(std::string_view path);

} // namespace grandamp
