#pragma once

#include <Jolt/Jolt.h>

namespace JPH {

class BodyID {
public:
    BodyID() = default;
    explicit BodyID(uint32 number) : value(number) {}
    uint32 value = 0xffffffff;
};

class MotionProperties {};

class Body {
public:
    bool IsSoftBody() const { return soft; }
    bool IsActive() const { return active; }
    bool IsInBroadPhase() const { return added; }
    float GetFriction() const { return friction; }
    void ResetSleepTimer() {}
    RMat44 GetCenterOfMassTransform() const { return transform; }
    MotionProperties* GetMotionPropertiesUnchecked() { return properties; }

    MotionProperties* properties = nullptr;
    RMat44 transform;
    bool soft = true, active = true, added = true;
    float friction = 0.2f;
};

} // namespace JPH
