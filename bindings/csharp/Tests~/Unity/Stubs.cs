// As much of Unity as the package names, so that the code for it is compiled here too. It is not run.
using System;

namespace AOT
{
    public sealed class MonoPInvokeCallbackAttribute : Attribute
    {
        public MonoPInvokeCallbackAttribute(Type type) { }
    }
}

namespace Unity.Collections
{
    public enum Allocator { None }
    public struct NativeArray<T> where T : struct { }
}

namespace Unity.Collections.LowLevel.Unsafe
{
    public struct AtomicSafetyHandle
    {
        public static AtomicSafetyHandle Create() { return new AtomicSafetyHandle(); }
        public static void Release(AtomicSafetyHandle handle) { }
        public static void CheckDeallocateAndThrow(AtomicSafetyHandle handle) { }
    }

    public static class NativeArrayUnsafeUtility
    {
        public static unsafe NativeArray<T> ConvertExistingDataToNativeArray<T>(void* data, int length, Allocator allocator)
            where T : struct { return new NativeArray<T>(); }
        public static void SetAtomicSafetyHandle<T>(ref NativeArray<T> array, AtomicSafetyHandle handle) where T : struct { }
    }
}

namespace UnityEngine
{
    public class MonoBehaviour { }
    public static class Debug { public static void Log(object message) { } }
    public static class Time { public static float time { get { return 0; } } }
    public static class Application { public static bool isPlaying { get { return true; } } }
    public static class Mathf { public static float PingPong(float t, float length) { return t % length; } }
    public struct Color
    {
        public static Color red { get { return new Color(); } }
        public static Color yellow { get { return new Color(); } }
    }
    public struct Vector3
    {
        public Vector3(float x, float y, float z) { }
        public static Vector3 operator *(Vector3 v, float s) { return v; }
    }
    public static class Gizmos
    {
        public static Color color { set { } }
        public static void DrawSphere(Vector3 centre, float radius) { }
        public static void DrawRay(Vector3 from, Vector3 direction) { }
    }
}
