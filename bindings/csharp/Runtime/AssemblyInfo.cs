using System.Runtime.CompilerServices;

[assembly: InternalsVisibleTo("VoxtetTests")]
