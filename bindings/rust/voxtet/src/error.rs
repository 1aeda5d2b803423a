use std::ffi::CStr;
use std::fmt;

use voxtet_sys as sys;

/// What went wrong, by kind; `vox_result` in vox.h.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ErrorCode {
    /// An unknown enum, a bad number.
    InvalidArgument,
    /// A mesh that was removed, or is of another grid.
    InvalidHandle,
    /// A tetrahedron names a vertex that does not exist.
    InvalidMesh,
    /// The call does not fit the state.
    InvalidState,
    /// A position is NaN or infinite.
    NonFinite,
    /// A documented limit would be passed.
    Limit,
    /// The grid's byte budget would be passed.
    Budget,
    /// There is no memory.
    OutOfMemory,
    /// Recognised, but not supported by this build or version.
    Unsupported,
    /// A file cannot be opened, read or written.
    File,
    /// A file is malformed.
    Format,
    /// A defect of the library.
    Internal,
    /// A code of a later library.
    Other(i32),
}

impl ErrorCode {
    pub(crate) fn of(result: sys::vox_result) -> Self {
        match result {
            sys::VOX_ERROR_INVALID_ARGUMENT => Self::InvalidArgument,
            sys::VOX_ERROR_INVALID_HANDLE => Self::InvalidHandle,
            sys::VOX_ERROR_INVALID_MESH => Self::InvalidMesh,
            sys::VOX_ERROR_INVALID_STATE => Self::InvalidState,
            sys::VOX_ERROR_NON_FINITE => Self::NonFinite,
            sys::VOX_ERROR_LIMIT => Self::Limit,
            sys::VOX_ERROR_BUDGET => Self::Budget,
            sys::VOX_ERROR_OUT_OF_MEMORY => Self::OutOfMemory,
            sys::VOX_ERROR_UNSUPPORTED => Self::Unsupported,
            sys::VOX_ERROR_FILE => Self::File,
            sys::VOX_ERROR_FORMAT => Self::Format,
            sys::VOX_ERROR_INTERNAL => Self::Internal,
            other => Self::Other(other),
        }
    }

    /// The number that C has for it.
    pub fn number(self) -> i32 {
        match self {
            Self::InvalidArgument => sys::VOX_ERROR_INVALID_ARGUMENT,
            Self::InvalidHandle => sys::VOX_ERROR_INVALID_HANDLE,
            Self::InvalidMesh => sys::VOX_ERROR_INVALID_MESH,
            Self::InvalidState => sys::VOX_ERROR_INVALID_STATE,
            Self::NonFinite => sys::VOX_ERROR_NON_FINITE,
            Self::Limit => sys::VOX_ERROR_LIMIT,
            Self::Budget => sys::VOX_ERROR_BUDGET,
            Self::OutOfMemory => sys::VOX_ERROR_OUT_OF_MEMORY,
            Self::Unsupported => sys::VOX_ERROR_UNSUPPORTED,
            Self::File => sys::VOX_ERROR_FILE,
            Self::Format => sys::VOX_ERROR_FORMAT,
            Self::Internal => sys::VOX_ERROR_INTERNAL,
            Self::Other(number) => number,
        }
    }
}

/// A failure, with the library's text, which has the numbers in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    code: ErrorCode,
    text: String,
}

impl Error {
    pub(crate) fn new(code: ErrorCode, text: impl Into<String>) -> Self {
        Self { code, text: text.into() }
    }

    /// What kind of failure it is.
    pub fn code(&self) -> ErrorCode {
        self.code
    }
}

impl fmt::Display for Error {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str(&self.text)
    }
}

impl std::error::Error for Error {}

/// What most functions return.
pub type Result<T> = std::result::Result<T, Error>;

/// Of a call that was just made on this thread.
pub(crate) fn check(result: sys::vox_result) -> Result<()> {
    if result == sys::VOX_OK {
        return Ok(());
    }
    // SAFETY: never null, and the text of this thread's last failure lives until the next one.
    let text = unsafe { CStr::from_ptr(sys::vox_last_error()) };
    Err(Error::new(ErrorCode::of(result), text.to_string_lossy()))
}

/// A struct of C that may grow, with its size and otherwise zeros: the defaults.
macro_rules! sized {
    ($type:ty) => {{
        type Struct = $type;
        // SAFETY: it has numbers, pointers and optional functions, each of which may be zero.
        Struct { struct_size: std::mem::size_of::<Struct>() as u32, ..unsafe { std::mem::zeroed() } }
    }};
}
pub(crate) use sized;
