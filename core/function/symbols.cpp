#include "core/function/symbols.h"

#include <cstddef>
#include <utility>

namespace lightwalk::function {
namespace {

/// x + C, or x alone when the name ends with a mark. Leading marks go.
std::string local_name(std::string_view name, std::string_view context) {
    if (name.front() == '`') {
        name.remove_prefix(1);
    } else if (name.back() == '`') {
        return std::string(name.substr(0, name.size() - 1));
    }
    return std::string(name).append(context);
}

bool only_one_level(std::string_view name) {
    return name.front() == '`' || name.back() == '`';
}

bool ends_with_cal(std::string_view file) {
    if (file.size() <= 4) return false;
    constexpr std::string_view kSuffix = ".cal";
    for (std::size_t i = 0; i < kSuffix.size(); ++i) {
        const char c = file[file.size() - kSuffix.size() + i];
        const char lower = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        if (lower != kSuffix[i]) return false;
    }
    return true;
}

}  // namespace

SymbolTable::SymbolTable(FunctionEnvironment::Library library) : library_(library) {
    for (const LibraryEntry& builtin : library_functions()) {
        if (find_library_function(builtin.name, library)) entry(std::string(builtin.name));
    }
}

std::optional<SymbolId> SymbolTable::find(std::string_view name, std::string_view context) const {
    if (name.empty()) return std::nullopt;
    for (;;) {
        const auto found = ids_.find(local_name(name, context));
        if (found != ids_.end()) return found->second;
        if (context.empty() || only_one_level(name)) return std::nullopt;
        const std::size_t next = context.find('`', 1);
        context.remove_prefix(next == std::string_view::npos ? context.size() : next);
    }
}

SymbolId SymbolTable::entry(const std::string& qualified) {
    const auto [found, is_new] =
        ids_.try_emplace(qualified, static_cast<SymbolId>(symbols_.size()));
    if (is_new) {
        symbols_.push_back({qualified, find_library_function(qualified, library_), std::nullopt});
    }
    return found->second;
}

SymbolId SymbolTable::refer(std::string_view name, std::string_view context) {
    if (const auto known = find(name, context)) return *known;
    return entry(local_name(name, context));
}

void SymbolTable::define(std::string_view name, std::string_view context, Definition definition) {
    symbols_[entry(local_name(name, context))].definition = std::move(definition);
}

std::string context_of_file(std::string_view file) {
    if (file == ".") return {};
    if (ends_with_cal(file)) file.remove_suffix(4);
    while (!file.empty() && file.front() == '`') file.remove_prefix(1);
    std::string context = "`";
    for (const char c : file) context += is_name_character(c) ? c : '_';
    return context;
}

}  // namespace lightwalk::function
