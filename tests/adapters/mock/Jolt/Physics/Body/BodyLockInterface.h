#pragma once

#include <Jolt/Physics/Body/Body.h>

namespace JPH {

class BodyLockInterface {
public:
    Body* TryGetBody(const BodyID& id) const { return id.value < bodies.size() ? bodies[id.value] : nullptr; }

    std::vector<Body*> bodies; // null: destroyed
};

} // namespace JPH
