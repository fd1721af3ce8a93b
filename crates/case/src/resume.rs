//! Going on with a run from the checkpoint in its results folder.

use std::path::{Path, PathBuf};

use std::sync::Arc;

use carom_dynamics::{Observer, Silent, go_on};
use carom_output::checkpoint::{self, Checkpoint};
use carom_output::{Error, Folder, Results};
use carom_ranks::Ranks;

use crate::complete::build;
use crate::error::Problem;
use crate::input::{Input, Source};
use crate::locate::Locator;
use crate::lower::Built;
use crate::origin::Origin;
use crate::parse::parse;
use crate::ranks::{begin, go_through};
use crate::run::{Begin, Failed, Finished, comments, march_from, settings};
use crate::schema::Case;

/// A run that can go on. Nothing in its folder has been changed.
pub struct Resume {
    input: Input,
    case: Case,
    locator: Locator,
    /// The case as built; none on other ranks than the first.
    pub built: Option<Built>,
    /// The folder, which no other run may open; none on other ranks than the first.
    folder: Option<Folder>,
    path: PathBuf,
    checkpoint: Box<Checkpoint>,
    origin: Origin,
    /// Why newer checkpoints are not used.
    pub unusable: Vec<Error>,
}

/// Why a run cannot go on.
#[derive(Debug)]
pub enum NotResumed {
    /// The folder or its checkpoints cannot be used.
    Folder(Error),
    /// The case cannot be built, or is another one than that of the checkpoint.
    Case(Vec<Source>, Vec<Problem>),
}

impl Resume {
    /// Reads the newest checkpoint of a results folder and the case that stands there, with the overrides of the run and further
    /// ones. These may change `output`, `title` and `time.end`.
    ///
    /// # Errors
    /// No results folder, or one that another run writes into; no checkpoint that can be used; problems of the case; a case of
    /// another model, with each key that differs.
    pub fn open(path: &Path, overrides: &[String]) -> Result<Resume, NotResumed> {
        let folder = Folder::open(path).map_err(NotResumed::Folder)?;
        Resume::read(path, overrides, Some(folder))
    }

    /// The same on a rank that writes no results, while the first one has opened the folder.
    ///
    /// # Errors
    /// As [`Resume::open`], but for the folder.
    pub fn open_beside(path: &Path, overrides: &[String]) -> Result<Resume, NotResumed> {
        Resume::read(path, overrides, None)
    }

    fn read(
        path: &Path,
        overrides: &[String],
        folder: Option<Folder>,
    ) -> Result<Resume, NotResumed> {
        let (checkpoint, unusable) = checkpoint::latest(path).map_err(NotResumed::Folder)?;
        let mut origin: Origin = serde_json::from_str(&checkpoint.origin)
            .map_err(|cause| Error::Checkpoint {
                path: path.join(checkpoint::FOLDER),
                cause: cause.to_string(),
            })
            .map_err(NotResumed::Folder)?;
        let written = comments(&origin.overrides);
        origin.overrides.extend_from_slice(overrides);
        let mut input = Input::read(&path.join("case.toml"), &origin.overrides)
            .map_err(|problems| NotResumed::Case(Vec::new(), problems))?;
        input.folder = path.join(&origin.folder);
        let refused = |problems| NotResumed::Case(input.sources.clone(), problems);
        let (case, locator) = parse(&input).map_err(refused)?;
        let problems = origin.differences(&case, &input, checkpoint.head.time);
        if !problems.is_empty() {
            return Err(refused(locator.locate_all(problems)));
        }
        let built = match &folder {
            Some(_) => Some(build(&case, &locator, &input).map_err(refused)?),
            None => None,
        };
        // the copy in the folder begins with the overrides, which it is given anew
        if let Some(file) = input.sources.first_mut()
            && let Some(text) = file.text.strip_prefix(&written)
        {
            file.text = text.to_owned();
        }
        let title = case.title.clone();
        origin.title = title.unwrap_or(origin.title);
        Ok(Resume {
            input,
            case,
            locator,
            built,
            folder,
            path: path.to_owned(),
            checkpoint: Box::new(checkpoint),
            origin,
            unusable,
        })
    }

    /// Step and simulated time (s) of the checkpoint.
    pub fn instant(&self) -> (u64, f64) {
        (self.checkpoint.head.step, self.checkpoint.head.time)
    }

    /// Time at which the run is to end, s.
    pub fn end(&self) -> f64 {
        self.case.time.end.0
    }

    /// Writes figures, report and summary as they are at the checkpoint. Histories, impacts and fields stay as they are, those after the
    /// checkpoint included, and the run can go on as before.
    ///
    /// # Errors
    /// As [`run`](crate::run()).
    pub fn report(self) -> Result<Finished, Failed> {
        let (Some(folder), Some(built)) = (self.folder, self.built) else {
            return Err(Failed::Start(carom_dynamics::Error::FirstRank));
        };
        let case = (&self.input, &self.case, &built);
        let settings = settings(case, self.path, &self.origin);
        let begin = Begin::Review(self.checkpoint, folder);
        let stop = &|| false;
        march_from((&built, settings), begin, &mut Silent, stop)
    }

    /// Goes on to the end of the case, as [`run`](crate::run()).
    ///
    /// # Errors
    /// As [`run`](crate::run()); a folder that has less than the checkpoint says.
    pub fn run(
        self,
        progress: &mut dyn Observer,
        stop: &dyn Fn() -> bool,
    ) -> Result<Finished, Failed> {
        let origin = self.origin.of_the_rest(&self.input, &self.case);
        let (Some(folder), Some(built)) = (self.folder, self.built) else {
            return Err(Failed::Start(carom_dynamics::Error::FirstRank));
        };
        let settings = settings((&self.input, &self.case, &built), self.path, &origin);
        let begin = Begin::Checkpoint(self.checkpoint, folder);
        march_from((&built, settings), begin, progress, stop)
    }

    /// The same on several ranks, which have all opened it; what the first one has to tell.
    ///
    /// # Errors
    /// As [`run_on_ranks`](crate::run_on_ranks).
    pub fn run_on_ranks(
        self,
        ranks: &Ranks,
        progress: &mut dyn Observer,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<Finished>, Failed> {
        let Resume {
            input,
            case,
            locator,
            built,
            folder,
            path,
            mut checkpoint,
            origin,
            ..
        } = self;
        let origin = origin.of_the_rest(&input, &case);
        let costs = checkpoint.costs()?;
        // the results need it no longer
        let state = std::mem::take(&mut checkpoint.state);
        let read = (&input, &case, &locator);
        let begun = begin((ranks, read), built, (path, &origin), Some((state, costs)))?;
        let system = Arc::clone(&begun.built.system);
        let results = |settings| match folder {
            Some(folder) => Results::resume(folder, &checkpoint, settings, system),
            None => Err(Error::NoResults {
                path: PathBuf::new(),
            }),
        };
        let results = (results, Some(&*checkpoint));
        go_through(ranks, begun, go_on, results, (progress, stop))
    }
}
