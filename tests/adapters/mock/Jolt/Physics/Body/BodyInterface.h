#pragma once

#include <Jolt/Physics/Body/BodyLockInterface.h>

namespace JPH {

class BodyInterface : public BodyLockInterface {
public:
    void ActivateBody(const BodyID& id) { TryGetBody(id)->active = true; }
};

} // namespace JPH
