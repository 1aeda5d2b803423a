#pragma once

#include <Jolt/Physics/Body/BodyInterface.h>
#include <Jolt/Physics/PhysicsStepListener.h>
#include <Jolt/Physics/SoftBody/SoftBodyMotionProperties.h>

#include <algorithm>

namespace JPH {

class PhysicsSystem {
public:
    const BodyLockInterface& GetBodyLockInterfaceNoLock() const { return bodies; }
    BodyInterface& GetBodyInterfaceNoLock() { return bodies; }
    void AddStepListener(PhysicsStepListener* listener) { listeners.push_back(listener); }
    void RemoveStepListener(PhysicsStepListener* listener) {
        listeners.erase(std::find(listeners.begin(), listeners.end(), listener));
    }
    void Update(float seconds, float gravity) {
        const PhysicsStepListenerContext context{seconds};
        for (PhysicsStepListener* listener : listeners) listener->OnStep(context);
        for (Body* body : bodies.bodies)
            if (body && body->active && body->added)
                static_cast<SoftBodyMotionProperties*>(body->properties)->Update(*body, seconds, gravity);
    }

    BodyInterface bodies;
    std::vector<PhysicsStepListener*> listeners;
};

} // namespace JPH
