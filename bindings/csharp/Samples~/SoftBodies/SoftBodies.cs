using UnityEngine;
using Voxtet;

/// <summary>Two bodies made in code; one sinks into the other. Put it on an empty object and press play: gizmos show the
/// contacts, and the way out of each vertex that is inside.</summary>
public sealed class SoftBodies : MonoBehaviour
{
    public float speed = 0.2f;

    Grid grid;
    Voxtet.Body ball, block;
    float[] rest;

    void OnEnable()
    {
        grid = new Grid(new GridOptions
        {
            Flags = GridFlags.Constraints, Workers = Grid.AllCores, Log = (level, text) => Debug.Log(level + ": " + text)
        });
        using (MeshFile shape = MeshFile.Box(2, 0.5, 2, 0.25)) block = grid.Add(shape.GetFloatPositions(), shape.GetTets());
        using (MeshFile shape = MeshFile.Ball(0.5, 0.12))
        {
            rest = shape.GetFloatPositions();
            ball = grid.Add(rest, shape.GetTets());
        }
    }

    void OnDisable()
    {
        grid.Dispose();
        grid = null; // gizmos are drawn for disabled objects, too
    }

    void FixedUpdate()
    {
        float height = 0.6f - Mathf.PingPong(Time.time * speed, 0.5f);
        Positions<float> positions = grid.GetPositions(ball);
        for (int i = 0; i < rest.Length; ++i) positions[i] = i % 3 == 1 ? rest[i] + height : rest[i];
        grid.Step();
    }

    void OnDrawGizmos()
    {
        if (grid == null || !Application.isPlaying) return;
        foreach (Constraint c in grid.Constraints)
        {
            var at = new Vector3((float)c.position.x, (float)c.position.y, (float)c.position.z);
            var way = new Vector3((float)c.normal.x, (float)c.normal.y, (float)c.normal.z);
            Gizmos.color = Color.red;
            Gizmos.DrawSphere(at, 0.01f);
            Gizmos.color = Color.yellow;
            Gizmos.DrawRay(at, way * -(float)c.gap);
        }
    }
}
