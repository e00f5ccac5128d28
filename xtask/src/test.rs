use crate::shell::Result;
pub fn selection(_o: &[String]) -> Result<()> {
    Ok(())
}
pub fn test(_o: &()) -> Result<()> {
    Ok(())
}
