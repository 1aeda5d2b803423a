// JSON for the output of the commands, which write it and never read it.
#pragma once

#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>

namespace tool {

// A value, held as its text. Numbers that are missing or not finite are null.
class Json {
public:
    struct Member;

    Json(std::nullptr_t = nullptr) : text_("null") {}
    Json(bool value) : text_(value ? "true" : "false") {}
    template <std::integral Number>
    Json(Number value) : text_(std::to_string(value)) {}
    Json(double value);
    Json(const std::optional<double>& value) : Json(value ? Json(*value) : Json()) {}
    Json(const char* text);
    Json(const std::string& text);               // bytes that are not UTF-8 are replaced
    Json(std::initializer_list<Member> members); // an object

    static Json object() { return Json(std::initializer_list<Member>()); }
    static Json array(std::initializer_list<Json> elements = {});
    template <class Elements>
    static Json array_of(const Elements& elements) {
        Json array = Json::array();
        for (const auto& element : elements) array.push_back(element);
        return array;
    }

    // Adds a new key to an object, or an element at the end of an array.
    void add(const std::string& key, const Json& value);
    void push_back(const Json& element);

    const std::string& text() const { return text_; }

private:
    void append(const std::string& text);

    std::string text_;
};

struct Json::Member {
    const char* key;
    Json value;
};

// The text with U+FFFD in the place of bytes that are not UTF-8.
std::string valid_utf8(const std::string& text);

} // namespace tool
