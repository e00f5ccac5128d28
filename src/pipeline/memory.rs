//! Keeps the octree, features and reduction of a cloud from one reconstruction to the next.

use crate::base::error::Result;
use crate::base::params::{Outliers, ReduceParams};
use crate::base::progress::Progress;
use crate::cloud::Cloud;
use crate::pipeline::input::Input;
use crate::pipeline::sites::Reduction;
use std::borrow::Cow;

/// The measurements of the last cloud and its last reduction: about 100 bytes a point.
#[derive(Debug, Default)]
pub struct Memory {
    input: Option<Input<'static>>,
    reduction: LastReduction,
}

/// How the remembered cloud was reduced, and what came out.
#[derive(Debug, Default)]
pub(crate) struct LastReduction(Option<(Option<ReduceParams>, Reduction)>);

impl Memory {
    /// The input of this cloud, measured unless it is remembered, and its last reduction. Of a cloud without its outliers
    /// nothing is remembered: it is another one than the caller hands over.
    pub(crate) fn input<'a>(
        &'a mut self,
        cloud: Cow<'a, Cloud>,
        outliers: Outliers,
        progress: &mut dyn Progress,
    ) -> Result<(Input<'a>, Option<&'a mut LastReduction>)> {
        if outliers == Outliers::Drop {
            *self = Memory::default();
            return Ok((Input::new(cloud, outliers, progress)?, None));
        }
        let input = match self.input.take().filter(|input| input.is_of(&cloud)) {
            Some(input) => input,
            None => {
                self.reduction = LastReduction::default();
                Input::new(Cow::Owned(cloud.into_owned()), outliers, progress)?
            }
        };
        // Remembered before the job goes on, so that one that is stopped loses nothing of what was measured.
        let input = self.input.insert(input);
        Ok((input.lent(), Some(&mut self.reduction)))
    }
}

impl LastReduction {
    /// The reduction by these options, made unless it is remembered. A job that is stopped keeps the one before.
    pub(crate) fn of(
        &mut self,
        params: &Option<ReduceParams>,
        make: impl FnOnce() -> Result<Reduction>,
    ) -> Result<Reduction> {
        match &self.0 {
            Some((last, reduction)) if last == params => Ok(reduction.clone()),
            _ => {
                let made = make()?;
                self.0 = Some((params.clone(), made.clone()));
                Ok(made)
            }
        }
    }
}
