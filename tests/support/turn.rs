//! Whose turn it is to use Vulkan. The validation layer of Debian 12 (1.3.239) finds its devices in
//! a map without a lock. If one thread creates or destroys a device while another thread calls
//! Vulkan, even on a device of its own, the layer can crash. So a test that makes a device runs
//! alone; tests on the shared devices run beside each other.

use std::cell::RefCell;
use std::sync::{PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard};

static LAYER: RwLock<()> = RwLock::new(());

thread_local! {
    /// The turn of the test on this thread.
    static OWN: RefCell<State> = const { RefCell::new(State::None) };
}

enum State {
    None,
    /// The number of turns taken and not dropped.
    Beside(u32, #[expect(dead_code, reason = "held")] RwLockReadGuard<'static, ()>),
    /// Until the thread ends: the test's devices can outlive the fixture that made them.
    Alone(#[expect(dead_code, reason = "held")] RwLockWriteGuard<'static, ()>),
}

/// A turn beside other tests ends when it is dropped, on the thread that took it. A turn alone lasts
/// until the thread ends.
pub struct Turn(());

/// Lets this test call Vulkan beside other tests.
pub fn beside() -> Turn {
    OWN.with_borrow_mut(|own| match own {
        State::None => {
            *own = State::Beside(1, LAYER.read().unwrap_or_else(PoisonError::into_inner));
        }
        State::Beside(turns, _) => *turns += 1,
        State::Alone(_) => {}
    });
    Turn(())
}

/// Lets this test create and destroy devices: no other test calls Vulkan until its thread ends.
pub fn alone() -> Turn {
    OWN.with_borrow_mut(|own| match own {
        State::None => *own = State::Alone(during()),
        State::Beside(..) => panic!("a test that makes its own device must not hold a shared one"),
        State::Alone(_) => {}
    });
    Turn(())
}

/// As [`alone`] for a thread without a turn, until the guard is dropped.
pub fn during() -> RwLockWriteGuard<'static, ()> {
    LAYER.write().unwrap_or_else(PoisonError::into_inner)
}

impl Drop for Turn {
    fn drop(&mut self) {
        OWN.with_borrow_mut(|own| match own {
            State::Beside(turns, _) if *turns > 1 => *turns -= 1,
            State::Beside(..) => *own = State::None,
            State::None | State::Alone(_) => {}
        });
    }
}
