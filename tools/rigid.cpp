#include "rigid.hpp"

#include "failure.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace tool {

namespace {

using Point = std::array<double, 3>;

// Numbers with commas between them.
std::vector<double> numbers_of(const std::string& option, const std::string& text, std::size_t count) {
    std::vector<double> numbers;
    const char* at = text.c_str();
    for (char* end = nullptr;; at = end + 1) {
        numbers.push_back(std::strtod(at, &end));
        if (end == at || (*end != ',' && *end != '\0') || !std::isfinite(numbers.back())) break;
        if (*end == '\0' && numbers.size() == count) return numbers;
        if (*end == '\0') break;
    }
    throw WrongUsage(option + ": expected " + std::to_string(count) +
                     " finite numbers with commas between them, found " + text);
}

Point across(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Point unit(const Point& a, double length) { return {a[0] / length, a[1] / length, a[2] / length}; }

// Takes the z axis to the unit vector `up`, and the origin to `origin`.
std::array<double, 12> place_of(const Point& up, const Point& origin) {
    std::size_t least = 0;
    for (std::size_t k = 1; k < 3; ++k)
        if (std::abs(up[k]) < std::abs(up[least])) least = k;
    Point axis{};
    axis[least] = 1;
    const Point side = across(axis, up);
    const Point x = unit(side, std::hypot(side[0], side[1], side[2])), y = across(up, x);
    std::array<double, 12> rows;
    for (std::size_t k = 0; k < 3; ++k) {
        rows[4 * k] = x[k];
        rows[4 * k + 1] = y[k];
        rows[4 * k + 2] = up[k];
        rows[4 * k + 3] = origin[k];
    }
    return rows;
}

constexpr Point upright = {0, 0, 1};

// How many numbers an option takes, and what shape they make.
struct Kind {
    const char* name;
    std::size_t count;
    void (*make)(Rigid& shape);
};

void make_floor(Rigid& shape) {
    const std::vector<double>& n = shape.numbers;
    const double length = std::hypot(n[0], n[1], n[2]);
    if (!(length > 0) || !std::isfinite(length))
        throw WrongUsage("--floor: the normal of " + name_of(shape) + " has no direction");
    const Point up = unit({n[0], n[1], n[2]}, length);
    const double height = n[3] / length;
    shape.desc.kind = VOX_SHAPE_HALF_SPACE;
    shape.place = place_of(up, {height * up[0], height * up[1], height * up[2]});
}

void make_sphere(Rigid& shape) {
    const std::vector<double>& n = shape.numbers;
    shape.desc.kind = VOX_SHAPE_SPHERE;
    shape.desc.radius = n[3];
    shape.place = place_of(upright, {n[0], n[1], n[2]});
}

void make_box(Rigid& shape) {
    const std::vector<double>& n = shape.numbers;
    shape.desc.kind = VOX_SHAPE_BOX;
    for (std::size_t k = 0; k < 3; ++k) shape.desc.half_size[k] = n[3 + k];
    shape.place = {1, 0, 0, n[0], 0, 1, 0, n[1], 0, 0, 1, n[2]};
}

void make_capsule(Rigid& shape) {
    const std::vector<double>& n = shape.numbers;
    const Point along = {n[3] - n[0], n[4] - n[1], n[5] - n[2]};
    const double length = std::hypot(along[0], along[1], along[2]);
    shape.desc.kind = VOX_SHAPE_CAPSULE;
    shape.desc.radius = n[6];
    shape.desc.half_length = length / 2;
    shape.place = place_of(length > 0 ? unit(along, length) : upright,
                           {n[0] + along[0] / 2, n[1] + along[1] / 2, n[2] + along[2] / 2});
}

constexpr Kind floor_kind = {"floor", 4, make_floor}, sphere_kind = {"sphere", 4, make_sphere},
               box_kind = {"box", 6, make_box}, capsule_kind = {"capsule", 7, make_capsule};

void make_all(const Kind& kind, const std::vector<std::string>& texts, std::vector<Rigid>& out) {
    for (const std::string& text : texts) {
        const std::string option = std::string("--") + kind.name;
        Rigid shape{kind.name, numbers_of(option, text, kind.count), vox_default_shape_desc(), {}};
        kind.make(shape);
        out.push_back(shape);
    }
}

} // namespace

std::vector<Rigid> RigidOptions::shapes() const {
    std::vector<Rigid> all;
    make_all(floor_kind, floors, all);
    make_all(sphere_kind, spheres, all);
    make_all(box_kind, boxes, all);
    make_all(capsule_kind, capsules, all);
    return all;
}

void add_rigid(Command& command, RigidOptions& options) {
    command.option("--floor", options.floors, "Rigid floor: the plane a x + b y + c z = d and all below it")
        .each()
        .shown_as("A,B,C,D");
    command.option("--sphere", options.spheres, "Rigid ball, by its centre and radius")
        .each()
        .shown_as("X,Y,Z,R");
    command.option("--box", options.boxes, "Rigid box, by its centre and half its sides")
        .each()
        .shown_as("X,Y,Z,HX,HY,HZ");
    command
        .option("--capsule", options.capsules,
                "Rigid capsule: what is within R of the segment from X,Y,Z to U,V,W")
        .each()
        .shown_as("X,Y,Z,U,V,W,R");
}

void insert_rigid(vox_grid* grid, const std::vector<Rigid>& shapes, std::vector<vox_body>& ids) {
    for (const Rigid& shape : shapes) {
        vox_body id = VOX_NULL_BODY;
        check(vox_shape_insert(grid, &shape.desc, &id));
        check(vox_body_set_transform(grid, id, shape.place.data()));
        ids.push_back(id);
    }
}

std::string name_of(const Rigid& shape) {
    std::string name = shape.kind;
    for (std::size_t i = 0; i < shape.numbers.size(); ++i) {
        char number[32];
        std::snprintf(number, sizeof number, "%c%.6g", i == 0 ? ' ' : ',', shape.numbers[i]);
        name += number;
    }
    return name;
}

Json rigid_list(const std::vector<Rigid>& shapes) {
    Json list = Json::array();
    for (const Rigid& shape : shapes)
        list.push_back({{"kind", shape.kind}, {"numbers", Json::array_of(shape.numbers)}});
    return list;
}

} // namespace tool
