#include "json.hpp"

#include <nlohmann/json.hpp>

namespace tool {

namespace {

std::string quoted(const std::string& text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

} // namespace

std::string valid_utf8(const std::string& text) {
    return nlohmann::json::parse(quoted(text)).get<std::string>();
}

Json::Json(double value) : text_(nlohmann::json(value).dump()) {}

Json::Json(const char* text) : text_(quoted(text)) {}

Json::Json(const std::string& text) : text_(quoted(text)) {}

Json::Json(std::initializer_list<Member> members) : text_("{}") {
    for (const Member& member : members) add(member.key, member.value);
}

Json Json::array(std::initializer_list<Json> elements) {
    Json array;
    array.text_ = "[]";
    for (const Json& element : elements) array.push_back(element);
    return array;
}

void Json::add(const std::string& key, const Json& value) { append(quoted(key) + ":" + value.text_); }

void Json::push_back(const Json& element) { append(element.text_); }

// Inserts before the closing bracket.
void Json::append(const std::string& text) {
    const char bracket = text_.back();
    text_.back() = ',';
    if (text_.size() == 2) text_.pop_back();
    text_ += text;
    text_ += bracket;
}

} // namespace tool
